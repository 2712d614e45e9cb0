// The certificate. By Sylvester's law the negative pivots at a shift count the
// eigenvalues below it, so the pairs that a band finds have numbers: going up
// and down from its shift. Invariants:
//  1. A band has all pairs between its ends, or it lacks one and counts the
//     pairs beyond it wrongly by one.
//  2. Neighbouring bands have no number in common that they use, none between
//     them, and a gap: the value of the first pair used of the upper band is
//     more than the last used of the lower by a gap that both have seen.
//  3. Were a pair missing in the lower band, its last would be the first of the
//     upper, and the gap none; likewise the other way round.
//  4. Beyond the last pair there is a shift of its own, for its count alone.
#include "core/spectrum/slicing.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <new>
#include <thread>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "core/base/status_macros.h"
#include "core/spectrum/shift_grid.h"

namespace marrow {
namespace {

constexpr int kMostRepairs = 3;
constexpr auto kReportEvery = std::chrono::milliseconds(20);
// Steps of a usual band, for progress alone.
constexpr double kUsualSteps = 12;
// What the analysis is of the whole.
constexpr double kAnalysisShare = 0.1;

struct FoundBand {
  PlannedBand plan;
  Band band;
  // Numbers of its pairs, from 0.
  int first() const { return plan.below_shift - band.below; }
  int end() const {
    return first() + static_cast<int>(band.values.size());
  }
  double Value(int number) const { return band.values[number - first()]; }
};

class Slicer {
 public:
  Slicer(const SupernodalStructure& matrix, int pairs,
         const SlicingOptions& options, const CancelToken& cancel)
      : matrix_(matrix),
        pairs_(pairs),
        options_(options),
        cancel_(cancel),
        workers_(matrix.branches.empty() ? options.threads : 1),
        grid_(pairs, options.band, options.tolerance) {}

  absl::Status FindBands(const ShareCallback& progress) {
    std::vector<std::thread> others;
    for (int t = 1; t < workers_; ++t)
      others.emplace_back([this] { Work(nullptr); });
    Work(progress);
    for (std::thread& other : others) other.join();
    absl::MutexLock lock(&mu_);
    return status_;
  }

  absl::StatusOr<SlicedSpectrum> Certify() {
    for (int repair = 0;; ++repair) {
      std::vector<bool> suspect(bands_.size(), false);
      std::vector<int> splits;
      MARROW_RETURN_IF_ERROR(FindSplits(suspect, splits));
      if (std::find(suspect.begin(), suspect.end(), true) == suspect.end())
        return Collect(splits);
      if (repair == kMostRepairs)
        return absl::InternalError("the count of the eigenvalues disagrees");
      for (size_t k = 0; k < bands_.size(); ++k)
        if (suspect[k]) MARROW_RETURN_IF_ERROR(Repair(*bands_[k], repair + 1));
    }
  }

 private:
  void Work(const ShareCallback& progress) {
    try {
      SupernodalFactor factor(matrix_);
      LanczosWorkspace workspace;
      Team team(options_.threads / workers_);
      while (WorkOnOne(factor, workspace, team, progress)) {
      }
    } catch (const std::bad_alloc&) {
      Fail(absl::ResourceExhaustedError(
          absl::StrCat("not enough memory for ", pairs_, " eigen-pairs of ",
                       matrix_.n, " vertices")));
    }
    if (progress) WaitForOthers(progress);
    absl::MutexLock lock(&mu_);
    ++finished_;
  }

  bool WorkOnOne(SupernodalFactor& factor, LanczosWorkspace& workspace,
                 Team& team, const ShareCallback& progress) {
    FoundBand* found;
    {
      absl::MutexLock lock(&mu_);
      if (!status_.ok() || grid_.done()) return false;
      bands_.push_back(std::make_unique<FoundBand>());
      found = bands_.back().get();
      // Each shift depends on the count at the one before, so this is done by
      // one thread at a time.
      status_.Update(grid_.Plan(factor, team, cancel_, found->plan));
      if (!status_.ok()) return false;
    }
    const BandRequest& request = found->plan.request;
    const double step = (request.below + request.above) / kUsualSteps;
    absl::StatusOr<Band> band =
        FindBand(matrix_, factor, request, workspace, team, cancel_, [&] {
          done_.store(done_.load() + step);
          if (progress) Report(progress);
        });
    if (!band.ok()) {
      Fail(band.status());
      return false;
    }
    found->band = *std::move(band);
    return true;
  }

  void Fail(absl::Status status) {
    absl::MutexLock lock(&mu_);
    status_.Update(std::move(status));
  }

  void WaitForOthers(const ShareCallback& progress) {
    const auto others_finished = [this]() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
      return finished_ == workers_ - 1;
    };
    absl::MutexLock lock(&mu_);
    while (!mu_.AwaitWithTimeout(absl::Condition(&others_finished),
                                 absl::FromChrono(kReportEvery))) {
      mu_.Unlock();
      Report(progress);
      mu_.Lock();
    }
  }

  // The number of steps is a guess: approaches 1 without reaching it.
  void Report(const ShareCallback& progress) {
    const double share = done_.load() / pairs_;
    const double guess = share < 0.8 ? share : 1 - 0.2 * 0.8 / share;
    reported_ = std::max(reported_, guess);
    progress(reported_);
  }

  // Where each band's pairs end and the next one's begin; marks the bands that
  // contradict each other or, the last, its count.
  absl::Status FindSplits(std::vector<bool>& suspect,
                          std::vector<int>& splits) {
    for (size_t k = 0; k + 1 < bands_.size(); ++k) {
      const FoundBand &low = *bands_[k], &high = *bands_[k + 1];
      splits.push_back(low.end());
      if (Agree(low, high)) continue;
      suspect[k] = suspect[k + 1] = true;
    }
    const FoundBand& last = *bands_.back();
    if (!last.plan.request.any_end_above && last.end() < matrix_.n) {
      const double from = last.band.values.back();
      const double beyond = std::isfinite(last.band.next_above)
                                ? 0.5 * (from + last.band.next_above)
                                : 1.01 * from;
      SupernodalFactor factor(matrix_);
      Team team(options_.threads);
      MARROW_RETURN_IF_ERROR(FactoriseNear(beyond, factor, team, cancel_));
      if (factor.negative_pivots() != last.end()) suspect.back() = true;
    }
    return absl::OkStatus();
  }

  static bool Agree(const FoundBand& low, const FoundBand& high) {
    const int split = low.end();
    if (high.first() > split || high.end() <= split) return false;
    const double first = high.Value(split);
    const double gap = std::min(low.band.next_above, first) -
                       low.band.values.back();
    const double seen = low.band.next_above - low.band.values.back();
    return gap > 0.5 * seen;
  }

  absl::Status Repair(FoundBand& found, int attempt) {
    SupernodalFactor factor(matrix_);
    LanczosWorkspace workspace;
    Team team(options_.threads);
    MARROW_RETURN_IF_ERROR(factor.Compute(found.plan.shift, team, cancel_));
    BandRequest request = found.plan.request;
    request.extra_steps = attempt;
    MARROW_ASSIGN_OR_RETURN(
        found.band,
        FindBand(matrix_, factor, request, workspace, team, cancel_, [] {}));
    return absl::OkStatus();
  }

  SlicedSpectrum Collect(const std::vector<int>& splits) {
    SlicedSpectrum result;
    result.order = matrix_.order;
    int number = 0;
    for (size_t k = 0; k < bands_.size(); ++k) {
      FoundBand& found = *bands_[k];
      const int end = k < splits.size() ? splits[k]
                                        : std::min(pairs_, found.end());
      const int first = found.first();
      result.residual = std::max(result.residual, found.band.residual);
      result.parts.push_back({std::move(found.band), number - first,
                              std::min(end, pairs_) - first});
      number = end;
    }
    result.ends_in_cluster = bands_.back()->plan.request.any_end_above;
    return result;
  }

  const SupernodalStructure& matrix_;
  const int pairs_;
  const SlicingOptions& options_;
  const CancelToken& cancel_;
  const int workers_;  // the threads that have a band each
  absl::Mutex mu_;
  ShiftGrid grid_;  // by one thread at a time, under mu_
  std::vector<std::unique_ptr<FoundBand>> bands_;
  absl::Status status_ ABSL_GUARDED_BY(mu_);
  int finished_ ABSL_GUARDED_BY(mu_) = 0;
  std::atomic<double> done_{0};
  double reported_ = 0;
};

}  // namespace

absl::StatusOr<SlicedSpectrum> SliceSpectrum(
    const Eigen::SparseMatrix<double>& matrix, const double* positions,
    int pairs, const SlicingOptions& options, const CancelToken& cancel,
    const ShareCallback& progress) {
  try {
    MARROW_ASSIGN_OR_RETURN(
        const SupernodalStructure structure,
        AnalyseStructure(matrix, positions, options.max_factor_bytes,
                         options.threads, cancel));
    progress(kAnalysisShare);
    Slicer slicer(structure, pairs, options, cancel);
    MARROW_RETURN_IF_ERROR(slicer.FindBands([&](double share) {
      progress(kAnalysisShare + (1 - kAnalysisShare) * share);
    }));
    return slicer.Certify();
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError(
        absl::StrCat("not enough memory for ", pairs, " eigen-pairs of ",
                     matrix.rows(), " vertices"));
  }
}

}  // namespace marrow
