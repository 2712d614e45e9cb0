// Eigen-pairs for those who want the spectrum itself: in double, with the
// residual of each and a count that shows whether one is missing.
#ifndef MARROW_CORE_SPECTRUM_CERTIFIED_SPECTRUM_H_
#define MARROW_CORE_SPECTRUM_CERTIFIED_SPECTRUM_H_

#include <Eigen/Core>
#include <cstdint>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/canonical_mesh.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// What a residual of the usual pairs is near, and what one of strict pairs is
// at most.
inline constexpr double kUsualResidual = 1e-4;
inline constexpr double kStrictResidual = 1e-8;

// L phi = lambda M phi on the canonical mesh, scaled to area 1. Immutable once
// built.
struct CertifiedSpectrum {
  Eigen::VectorXd eigenvalues;   // ascending; entry 0 is the constant pair's, 0
  Eigen::MatrixXd eigenvectors;  // n x pairs, a column a pair, M-orthonormal
  // |L phi - lambda M phi| in the M^-1 norm, in units of max(lambda, lambda_1).
  Eigen::VectorXd residuals;
  // The certificate: the negative pivots of L - bound M, which by Sylvester's
  // law are the eigenvalues below `bound`, are as many as the pairs below it.
  // It lies beyond the last pair, or, where that may have equals beyond the
  // number asked for, in the last gap below it.
  double bound = 0;
  uint32_t count_below_bound = 0;
  double area = 0;        // as in EigenPairs
  bool complete = false;  // as in EigenPairs

  uint32_t NumPairs() const {
    return static_cast<uint32_t>(eigenvalues.size());
  }
  uint64_t Bytes() const {
    return sizeof(double) *
           (eigenvalues.size() + eigenvectors.size() + residuals.size());
  }
};

// How many pairs to solve for so that `count` can be made strict: an iteration
// cannot part the last pairs from those that come after them unless it has some
// of those too.
uint32_t WithStrictGuards(uint32_t count);

// Takes away, by inverse iteration, what rounding to float left of a residual,
// until that of each of the lowest `count` pairs besides the constant one is at
// most `residual` or no longer falls, and counts. `pairs` are those of the
// mesh, with about that residual before they were rounded. Deterministic.
// Thread safe. Errors: CANCELLED; RESOURCE_EXHAUSTED; INTERNAL with reason
// SOLVER_NOT_CONVERGED where a pair is missing or there twice, or the vectors
// of very many equal eigenvalues cannot be told apart.
absl::StatusOr<CertifiedSpectrum> CertifySpectrum(
    const CanonicalMesh& mesh, const EigenPairs& pairs, uint32_t count,
    double residual, const CancelToken& cancel,
    const ProgressCallback& progress);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_CERTIFIED_SPECTRUM_H_
