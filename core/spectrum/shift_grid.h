// Where the shifts go, one after the other, and which pairs each is to find.
#ifndef MARROW_CORE_SPECTRUM_SHIFT_GRID_H_
#define MARROW_CORE_SPECTRUM_SHIFT_GRID_H_

#include <vector>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/band_lanczos.h"
#include "core/spectrum/supernodal_factor.h"

namespace marrow {

// A shift with its inertia, and what its band is asked for. The bands asked for
// follow each other without a hole: band k is to find the pairs numbered from
// below_shift - request.below up to below_shift + request.above.
struct PlannedBand {
  double shift = 0;
  int below_shift = 0;  // eigenvalues of the matrix below the shift
  BandRequest request;
};

// Plans the bands of the lowest `pairs` pairs. Each shift is guessed from the
// counts at those before it, and moved until the count at it fits. Not thread
// safe; its plan depends on the matrix and its parameters alone.
class ShiftGrid {
 public:
  // `wanted` is the size of a usual band.
  ShiftGrid(int pairs, int wanted, double tolerance)
      : pairs_(pairs), wanted_(wanted), tolerance_(tolerance) {}

  bool done() const { return covered_ >= pairs_; }
  int covered() const { return covered_; }

  // The next band; `factor` is left factorised at its shift. Errors: CANCELLED;
  // INTERNAL where no shift can be found. REQUIRES: !done().
  absl::Status Plan(SupernodalFactor& factor, Team& team, const CancelToken& cancel,
                    PlannedBand& band);

 private:
  double Guess() const;
  absl::Status Settle(SupernodalFactor& factor, Team& team, const CancelToken& cancel,
                      int& cluster_end,
                      bool& dense_above);

  const int pairs_;
  const int wanted_;
  const double tolerance_;
  int covered_ = 0;          // pairs that the bands planned so far find
  double last_shift_ = 0;    // of the band before
  int last_below_ = 0;       // and its count
  double mean_distance_ = 0;  // found between the last two shifts; 0: none yet
};

// Factorises at `shift`, or a little above it where that is an eigenvalue.
absl::Status FactoriseNear(double shift, SupernodalFactor& factor, Team& team,
                           const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SHIFT_GRID_H_
