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
  bool of_cluster = false;  // more equal eigenvalues than a usual band has
};

// Plans bands, ascending: the first is small, for those who need few pairs, and
// the following end where the usual counts do (10, 50, 100, 200 ... and the
// constant pair). Each shift is guessed from the counts at those before it, and
// moved until the count at it fits. Not thread safe. The plan depends on the
// matrix and the tolerance alone, not on how many pairs are asked for, with one
// exception: more equal eigenvalues than a band can have are one band that ends
// at `most_pairs`.
class ShiftGrid {
 public:
  ShiftGrid(int n, int most_pairs, const BandRequest& common);

  // Pairs that the bands planned so far find.
  int covered() const { return covered_; }
  // About where the last of them is.
  double Reach() const {
    return last_shift_ + mean_distance_ * (covered_ - last_below_);
  }

  // The next band; `factor` is left factorised at its shift. Errors: CANCELLED;
  // INTERNAL where no shift can be found.
  absl::Status Plan(SupernodalFactor& factor, Team& team,
                    const CancelToken& cancel, PlannedBand& band);

 private:
  int NextEnd() const;
  double Guess(int wanted) const;
  absl::Status FactoriseBelow(double low, int count, SupernodalFactor& factor,
                              Team& team, const CancelToken& cancel);
  absl::Status Settle(int wanted, SupernodalFactor& factor, Team& team,
                      const CancelToken& cancel, int& cluster_end,
                      bool& dense_above);

  const int usual_;  // pairs of a usual band
  const int most_pairs_;
  const BandRequest common_;
  int covered_ = 0;
  double last_shift_ = 0;  // of the band before
  int last_below_ = 0;     // and its count
  double mean_distance_;   // found between the last two shifts
};

// Factorises at `shift`, or a little above it where that is an eigenvalue.
absl::Status FactoriseNear(double shift, SupernodalFactor& factor, Team& team,
                           const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SHIFT_GRID_H_
