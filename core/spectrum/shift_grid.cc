#include "core/spectrum/shift_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Mean distance of a surface's eigenvalues, 4 pi (Weyl), less where there are
// few of them and boundaries or long limbs count: the first guess.
constexpr double kFirstDistance = 10;
// Pairs below a shift that are too many or too few for a band, in bands.
constexpr double kTooMany = 1.1;
constexpr double kTooFew = 0.3;
// A band's steps grow with its larger side: with fewer pairs than this on
// either, in bands, another shift is looked for, which costs as much as a step
// or two; but not more often than so.
constexpr double kSmallSide = 0.38;
constexpr int kBalancings = 1;
// Pairs of the first band, and of the usual ones. Small problems are cheap to
// factorise, and then the dense work on a basis is most of it; of large ones
// the basis is most of the memory.
constexpr int kFirstBand = 12;
constexpr int kUsualBand = 50;
constexpr int kSmallBand = 25;
constexpr int kSmallProblem = 12'000;
constexpr int kLargeBand = 40;
constexpr int kLargeProblem = 300'000;

constexpr int kMostTries = 60;
// An interval of this relative width that holds too many is a cluster.
constexpr double kClusterWidth = 1e-8;
// Many pairs in an interval this short, in units of the distance that holds
// few, are far denser than those.
constexpr double kStepWidth = 0.05;
constexpr int kMostNudges = 8;
constexpr double kNudge = 1e-7;

int UsualBand(int n) {
  if (n < kSmallProblem) return kSmallBand;
  return n < kLargeProblem ? kUsualBand : kLargeBand;
}

}  // namespace

absl::Status FactoriseNear(double shift, SupernodalFactor& factor, Team& team,
                           const CancelToken& cancel) {
  absl::Status status;
  for (int i = 0; i < kMostNudges; ++i) {
    status = factor.Compute(shift * (1 + i * kNudge), team, cancel);
    if (status.code() != absl::StatusCode::kFailedPrecondition) return status;
  }
  return absl::InternalError(
      absl::StrCat("the matrix cannot be factorised: ", status.message()));
}

ShiftGrid::ShiftGrid(int n, int most_pairs, const BandRequest& common)
    : usual_(UsualBand(n)),
      most_pairs_(most_pairs),
      common_(common),
      mean_distance_(kFirstDistance) {}

int ShiftGrid::NextEnd() const {
  if (covered_ == 0) return kFirstBand;
  const int past = covered_ + usual_ / 3 - 2;
  return 2 + usual_ * (past / usual_ + 1);
}

double ShiftGrid::Guess(int wanted) const {
  const int middle = covered_ + wanted / 2;
  return last_shift_ + mean_distance_ * (middle - last_below_);
}

// Factorises below a cluster that begins at `low`, where `count` eigenvalues
// are below, and as far from it as can be: near an eigenvalue pivots are tiny,
// and what many equal ones make of that no refinement mends.
absl::Status ShiftGrid::FactoriseBelow(double low, int count,
                                       SupernodalFactor& factor, Team& team,
                                       const CancelToken& cancel) {
  for (double back = 0.5 * mean_distance_; back > kClusterWidth * low;
       back /= 8) {
    if (low - back <= last_shift_) continue;
    MARROW_RETURN_IF_ERROR(FactoriseNear(low - back, factor, team, cancel));
    if (factor.negative_pivots() == count) return absl::OkStatus();
  }
  return FactoriseNear(low, factor, team, cancel);
}

// Moves the shift until the pairs below it that no band finds yet are as many
// as a band's. Where more than that are too close to be parted, the shift is
// left below them and `cluster_end` is the count above them, else 0. Where few
// pairs are far below very many, the shift is left amid the two and
// `dense_above`: seen from among the many, the few are lost.
absl::Status ShiftGrid::Settle(int wanted, SupernodalFactor& factor, Team& team,
                               const CancelToken& cancel, int& cluster_end,
                               bool& dense_above) {
  cluster_end = 0;
  dense_above = false;
  double low = last_shift_, high = kInfinity, shift = Guess(wanted);
  // Pairs between the shift before and those that are asked for.
  const int ahead = covered_ - last_below_;
  int high_count = 0, low_count = covered_;
  // The first band is small.
  int balancings = covered_ > 0 ? kBalancings : 0;
  for (int i = 0; i < kMostTries; ++i) {
    MARROW_RETURN_IF_ERROR(FactoriseNear(shift, factor, team, cancel));
    const int found = factor.negative_pivots() - covered_;
    const bool too_many = found > kTooMany * wanted;
    if (!too_many && found >= kTooFew * wanted) {
      const int least = static_cast<int>(kSmallSide * wanted);
      if (std::min(found, wanted - found) >= least || balancings-- == 0)
        return absl::OkStatus();
      shift = last_shift_ +
              (shift - last_shift_) * (0.5 * wanted + ahead) / (found + ahead);
      continue;
    }
    if (too_many) {
      high = shift;
      high_count = factor.negative_pivots();
    } else {
      low = shift;
      low_count = factor.negative_pivots();
    }
    if (low_count > covered_ && high - low < kStepWidth * (low - last_shift_)) {
      dense_above = true;
      MARROW_RETURN_IF_ERROR(
          FactoriseNear(0.5 * (last_shift_ + low), factor, team, cancel));
      if (factor.negative_pivots() == low_count) return absl::OkStatus();
      return FactoriseNear(low, factor, team, cancel);
    }
    if (high - low < kClusterWidth * high) {
      cluster_end = high_count;
      return FactoriseBelow(low, low_count, factor, team, cancel);
    }
    shift = std::isinf(high) ? last_shift_ + 2 * (shift - last_shift_)
                             : 0.5 * (low + high);
  }
  return absl::InternalError("no place for a shift was found");
}

absl::Status ShiftGrid::Plan(SupernodalFactor& factor, Team& team,
                             const CancelToken& cancel, PlannedBand& band) {
  int cluster_end;
  bool dense_above;
  const int end = NextEnd();
  MARROW_RETURN_IF_ERROR(
      Settle(end - covered_, factor, team, cancel, cluster_end, dense_above));
  band = PlannedBand();
  band.shift = factor.shift();
  band.below_shift = factor.negative_pivots();
  band.of_cluster = cluster_end > 0;
  band.request = common_;
  band.request.below = band.below_shift - covered_;
  band.request.all_below = covered_ == 0;
  band.request.any_end_below = covered_ == last_below_;
  int above = end - band.below_shift;
  if (cluster_end > 0) {
    above = std::min(most_pairs_, cluster_end) - band.below_shift;
    band.request.any_end_above = cluster_end > most_pairs_;
  }
  if (dense_above) above = 0;
  band.request.above = std::max(0, above);
  if (band.below_shift > last_below_)
    mean_distance_ =
        (band.shift - last_shift_) / (band.below_shift - last_below_);
  last_shift_ = band.shift;
  last_below_ = band.below_shift;
  covered_ = band.below_shift + band.request.above;
  return absl::OkStatus();
}

}  // namespace marrow
