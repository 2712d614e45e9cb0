// One step of block inverse iteration with Rayleigh-Ritz, in double.
#ifndef MARROW_CORE_SPECTRUM_INVERSE_ITERATION_H_
#define MARROW_CORE_SPECTRUM_INVERSE_ITERATION_H_

#include <Eigen/Core>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/lanczos_basis.h"
#include "core/spectrum/supernodal_factor.h"

namespace marrow {

// Approximate eigenvectors of one matrix, near one shift.
struct Window {
  // n x PaddedWidth(count), in the order of the factor's structure; columns
  // from `count` on are zero.
  RowMajorMatrix vectors;
  Eigen::VectorXd values;  // `count`, ascending

  static int PaddedWidth(int count) {
    return (count + kBlock - 1) / kBlock * kBlock;
  }
};

// Replaces the vectors by the Ritz vectors of (A - shift I)^-1 on them, which
// are orthonormal, and the values by the Ritz values. A component that an
// eigenvector of value mu has in one of value lambda shrinks by
// |lambda - shift| / |mu - shift|, unless it too is in the window: then it
// vanishes. Errors: CANCELLED; INTERNAL with reason
// SOLVER_NOT_CONVERGED where the vectors are dependent. May
// throw std::bad_alloc. REQUIRES: the vectors are about of length 1.
absl::Status IterateInversely(const SupernodalFactor& factor, Window& window,
                              const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_INVERSE_ITERATION_H_
