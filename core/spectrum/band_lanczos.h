// The eigen-pairs around one shift, by block Lanczos with the inverse of the
// shifted matrix.
#ifndef MARROW_CORE_SPECTRUM_BAND_LANCZOS_H_
#define MARROW_CORE_SPECTRUM_BAND_LANCZOS_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/aligned_buffer.h"
#include "core/spectrum/supernodal_factor.h"
#include "core/spectrum/team.h"

namespace marrow {

struct BandRequest {
  // How many pairs are wanted on either side of the shift, the nearest first.
  int below = 0;
  int above = 0;
  // Whether `below` is all there are, so that the lowest is lambda_0.
  bool all_below = false;
  // Whether the pairs may begin inside a cluster: a count is known there.
  bool any_end_below = false;
  // Whether the pairs may end inside a cluster above.
  bool any_end_above = false;
  // In units of max(lambda, lambda_1), what a residual may be.
  double tolerance = 0;
  // Whether the vectors are wanted as they are found, in double.
  bool exact = false;
  // Steps beyond those that seem enough, and another start: for a band that
  // was found to lack a pair.
  int extra_steps = 0;
};

// Consecutive eigen-pairs, ascending. It ends at gaps: a cluster is inside or
// outside, but for those ends where the request lets it be otherwise.
struct Band {
  std::vector<double> values;
  int below = 0;  // how many of them are below the shift
  // Approximate eigenvalues beyond either end; infinite where there are none or
  // the end may be anywhere.
  double next_below = 0;
  double next_above = 0;
  // n x values.size(), row-major, orthonormal to about 1e-8 before they were
  // rounded; empty where exact ones are wanted, which are there instead.
  std::vector<float> vectors;
  std::vector<double> exact_vectors;
  // Of each pair before it was rounded, in units of max(lambda, lambda_1).
  std::vector<double> residuals;
};

// Memory that one thread takes from band to band.
struct LanczosWorkspace {
  std::vector<AlignedBuffer> blocks;
};

// Called after every step.
using StepCallback = std::function<void()>;

// Finds at least the pairs asked for, more where a cluster wants it. The same
// bytes whatever the team; O(n) memory a vector of the basis, which has two to
// four times as many as there are pairs. Errors: CANCELLED; INTERNAL where the
// pairs do not converge. May throw std::bad_alloc.
absl::StatusOr<Band> FindBand(const SupernodalStructure& matrix,
                              const SupernodalFactor& factor,
                              const BandRequest& request,
                              LanczosWorkspace& workspace, Team& team,
                              const CancelToken& cancel,
                              const StepCallback& on_step);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_BAND_LANCZOS_H_
