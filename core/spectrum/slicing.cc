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
//  4. Beyond the last pair found so far, and wherever two bands disagree, there
//     is a shift of its own, for its count alone.
#include "core/spectrum/slicing.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "core/base/status_macros.h"
#include "core/spectrum/shift_grid.h"

namespace marrow {
namespace {

// A band that lacks pairs goes on for so many steps, then for twice as many:
// members of a cluster beyond what a block has columns come out of rounding, a
// block of them in about as many steps.
constexpr int kMostRepairs = 3;
constexpr int kMostExactRepairs = 5;  // rounding lies deeper
constexpr int kRepairSteps = 6;
constexpr auto kReportEvery = std::chrono::milliseconds(20);
// Pairs that a step brings nearer, as a share of a block, and the usual
// distance of eigenvalues: for progress alone.
constexpr double kPairsAStep = 0.29 * kBlock;
constexpr double kUsualDistance = 12;

struct FoundBand {
  PlannedBand plan;
  Band band;
  std::vector<InertiaCount> counts;
  // Numbers of its pairs, from 0.
  int first() const { return plan.below_shift - band.below; }
  int end() const { return first() + static_cast<int>(band.values.size()); }
  double Value(int number) const { return band.values[number - first()]; }
};

// Whether `high` goes on where `low` ends.
bool Agree(const FoundBand& low, const FoundBand& high) {
  const int split = low.end();
  if (high.first() > split || high.end() <= split) return false;
  const double first = high.Value(split);
  const double gap =
      std::min(low.band.next_above, first) - low.band.values.back();
  const double seen = low.band.next_above - low.band.values.back();
  return gap > 0.5 * seen;
}

absl::Status OutOfMemory(int n) {
  return absl::ResourceExhaustedError(absl::StrCat(
      "not enough memory for the eigen-pairs of ", n, " vertices"));
}

// What one thread, or a team, works with.
struct Desk {
  Desk(const SupernodalStructure& matrix, int threads)
      : factor(matrix), team(threads) {}
  SupernodalFactor factor;
  LanczosWorkspace workspace;
  Team team;
};

class Slicer : public SpectrumSlicer {
 public:
  Slicer(SupernodalStructure matrix, int most_pairs,
         const SlicingOptions& options)
      : matrix_(std::move(matrix)),
        options_(options),
        workers_(matrix_.branches.empty() ? options.threads : 1),
        grid_(matrix_.n, most_pairs, CommonRequest(options)) {}

  const std::vector<int>& order() const override { return matrix_.order; }

  absl::StatusOr<std::vector<SpectrumPart>> Find(
      const PairsWanted& wanted, const CancelToken& cancel,
      const ShareCallback& progress) override {
    std::vector<SpectrumPart> parts;
    try {
      Report report(*this, wanted, progress);
      while (!Has(wanted) && (status_.ok() || parts.empty())) {
        MARROW_RETURN_IF_ERROR(status_);
        MARROW_RETURN_IF_ERROR(FindMore(wanted, cancel, report));
        if (certified_ == bands_.size() && status_.ok()) break;
        while (certified_ < bands_.size()) parts.push_back(NextPart());
      }
    } catch (const std::bad_alloc&) {
      return OutOfMemory(matrix_.n);
    }
    return parts;
  }

  absl::StatusOr<InertiaCount> Count(double shift,
                                     const CancelToken& cancel) override {
    try {
      Team team(options_.threads);
      SupernodalFactor factor(matrix_);
      MARROW_RETURN_IF_ERROR(FactoriseNear(shift, factor, team, cancel));
      return InertiaCount{factor.shift(), factor.negative_pivots()};
    } catch (const std::bad_alloc&) {
      return OutOfMemory(matrix_.n);
    }
  }

 private:
  // Work done as a share of what is expected; approaches 1 without reaching it.
  class Report {
   public:
    Report(const Slicer& slicer, const PairsWanted& wanted,
           const ShareCallback& callback)
        : done_(slicer.done_), callback_(callback) {
      const double pairs =
          std::min<double>(wanted.pairs, 12 + wanted.bound / kUsualDistance);
      begin_ = std::min(done_.load(), pairs - 1);
      expected_ = pairs - begin_;
    }
    void operator()() {
      const double share = (done_.load() - begin_) / expected_;
      const double guess = share < 0.8 ? share : 1 - 0.2 * 0.8 / share;
      reported_ = std::max(reported_, guess);
      callback_(reported_);
    }

   private:
    const std::atomic<double>& done_;
    const ShareCallback& callback_;
    double begin_, expected_;
    double reported_ = 0;
  };

  static BandRequest CommonRequest(const SlicingOptions& options) {
    BandRequest request;
    request.tolerance = options.tolerance;
    request.exact = options.exact;
    return request;
  }

  int NumPairs() const { return bands_.empty() ? 0 : bands_.back()->end(); }

  bool Has(const PairsWanted& wanted) const {
    return NumPairs() >= wanted.pairs ||
           (NumPairs() > 0 && NumPairs() >= wanted.least &&
            bands_.back()->band.values.back() > wanted.bound);
  }

  // At least one band more, or an error in status_. Of the bands at work when
  // one fails, those before it are kept, which are the same for any number of
  // threads.
  absl::Status FindMore(const PairsWanted& wanted, const CancelToken& cancel,
                        Report& report) {
    const size_t before = bands_.size();
    const auto enough = [&] {
      return bands_.size() > before && (grid_.covered() >= wanted.pairs ||
                                        (grid_.covered() >= wanted.least &&
                                         grid_.Reach() > wanted.bound));
    };
    const Task task{enough, std::isfinite(wanted.bound), cancel};
    Desk desk(matrix_, options_.threads / workers_);
    sound_ = std::numeric_limits<size_t>::max();
    finished_ = 0;
    std::vector<std::thread> others;
    for (int t = 1; t < workers_; ++t)
      others.emplace_back([&] { WorkBeside(task); });
    Work(task, desk, [&] { report(); });
    WaitForOthers(report);
    for (std::thread& other : others) other.join();
    if (status_.code() != absl::StatusCode::kInternal)
      MARROW_RETURN_IF_ERROR(status_);
    bands_.resize(std::min(sound_, bands_.size()));
    desk.workspace = {};
    for (size_t k = certified_; k < bands_.size(); ++k)
      if (absl::Status status = Certify(k, desk, cancel); !status.ok()) {
        if (status.code() != absl::StatusCode::kInternal) return status;
        Fail(std::move(status), k);
        bands_.resize(k);
      }
    return absl::OkStatus();
  }

  struct Task {
    std::function<bool()> enough;  // to be asked under mu_
    bool stops_at_cluster;  // where it is larger than all that may be asked for
    const CancelToken& cancel;
  };

  void WorkBeside(const Task& task) {
    try {
      Desk desk(matrix_, 1);
      Work(task, desk, [] {});
    } catch (const std::bad_alloc&) {
      Fail(OutOfMemory(matrix_.n), 0);
    }
    absl::MutexLock lock(&mu_);
    ++finished_;
  }

  void Work(const Task& task, Desk& desk, const StepCallback& report) {
    try {
      while (WorkOnOne(task, desk, report)) {
      }
    } catch (const std::bad_alloc&) {
      Fail(OutOfMemory(matrix_.n), 0);
    }
  }

  bool WorkOnOne(const Task& task, Desk& desk, const StepCallback& report) {
    FoundBand* found;
    size_t index;
    {
      absl::MutexLock lock(&mu_);
      if (!status_.ok() || task.enough()) return false;
      index = bands_.size();
      PlannedBand plan;
      if (absl::Status status = Plan(task, desk, plan); !status.ok()) {
        NoteFailure(std::move(status), index);
        return false;
      }
      if (cluster_.has_value()) return false;
      bands_.push_back(std::make_unique<FoundBand>());
      found = bands_.back().get();
      found->plan = plan;
    }
    found->counts.push_back({found->plan.shift, found->plan.below_shift});
    absl::StatusOr<Band> band =
        FindBand(matrix_, desk.factor, found->plan.request, desk.workspace,
                 desk.team, task.cancel, [&] {
                   done_.store(done_.load() + kPairsAStep);
                   report();
                 });
    if (!band.ok()) {
      Fail(band.status(), index);
      return false;
    }
    found->band = *std::move(band);
    return true;
  }

  // The next band, with desk.factor at its shift, or cluster_. Each shift
  // depends on the count at the one before, so this is done by one thread at a
  // time.
  absl::Status Plan(const Task& task, Desk& desk, PlannedBand& plan)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    if (!cluster_.has_value()) {
      MARROW_RETURN_IF_ERROR(
          grid_.Plan(desk.factor, desk.team, task.cancel, plan));
      if (task.stops_at_cluster && plan.request.any_end_above) cluster_ = plan;
    } else if (!task.stops_at_cluster) {
      plan = *std::exchange(cluster_, std::nullopt);
      return desk.factor.Compute(plan.shift, desk.team, task.cancel);
    }
    return absl::OkStatus();
  }

  void Fail(absl::Status status, size_t band) {
    absl::MutexLock lock(&mu_);
    NoteFailure(std::move(status), band);
  }

  // The error of the first band that fails counts, but what is no matter of a
  // band goes before.
  void NoteFailure(absl::Status status, size_t band)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    const bool was_internal =
        status_.ok() || status_.code() == absl::StatusCode::kInternal;
    const bool is_internal = status.code() == absl::StatusCode::kInternal;
    if (was_internal && (!is_internal || band < sound_))
      status_ = std::move(status);
    sound_ = std::min(sound_, band);
  }

  void WaitForOthers(Report& report) {
    const auto others_finished = [this]() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
      return finished_ == workers_ - 1;
    };
    absl::MutexLock lock(&mu_);
    while (!mu_.AwaitWithTimeout(absl::Condition(&others_finished),
                                 absl::FromChrono(kReportEvery))) {
      mu_.Unlock();
      report();
      mu_.Lock();
    }
  }

  // Compares band k with its neighbours or, at its upper end, with a count of
  // its own. The bands before it are certified. Which bands are mended does not
  // depend on whether the next one is there already.
  absl::Status Certify(size_t k, Desk& desk, const CancelToken& cancel) {
    FoundBand& found = *bands_[k];
    for (int repair = 0;; ++repair) {
      bool sound = k == 0 || Agree(*bands_[k - 1], found);
      if (sound && !(k + 1 < bands_.size() && Agree(found, *bands_[k + 1]))) {
        MARROW_ASSIGN_OR_RETURN(sound, CountsAgree(found, desk, cancel));
      }
      if (sound) return absl::OkStatus();
      if (repair == (options_.exact ? kMostExactRepairs : kMostRepairs))
        return absl::InternalError("the count of the eigenvalues disagrees");
      BandRequest request = found.plan.request;
      request.extra_steps = kRepairSteps << repair;
      MARROW_RETURN_IF_ERROR(
          desk.factor.Compute(found.plan.shift, desk.team, cancel));
      MARROW_ASSIGN_OR_RETURN(
          found.band, FindBand(matrix_, desk.factor, request, desk.workspace,
                               desk.team, cancel, [] {}));
    }
  }

  // Counts the eigenvalues below the gap that ends a band.
  absl::StatusOr<bool> CountsAgree(FoundBand& found, Desk& desk,
                                   const CancelToken& cancel) {
    if (found.plan.request.any_end_above || found.end() >= matrix_.n)
      return true;
    const double from = found.band.values.back();
    const double next = found.band.next_above;
    const double beyond =
        std::isfinite(next) ? 0.5 * (from + next) : 1.01 * from;
    MARROW_RETURN_IF_ERROR(
        FactoriseNear(beyond, desk.factor, desk.team, cancel));
    found.counts.push_back(
        {desk.factor.shift(), desk.factor.negative_pivots()});
    return desk.factor.negative_pivots() == found.end();
  }

  // Of the first band that was not handed on.
  SpectrumPart NextPart() {
    FoundBand& found = *bands_[certified_];
    const int begin = certified_ == 0 ? 0 : bands_[certified_ - 1]->end();
    ++certified_;
    SpectrumPart part;
    part.first = begin - found.first();
    part.end = static_cast<int>(found.band.values.size());
    part.of_cluster = found.plan.of_cluster;
    part.counts = found.counts;
    part.band = std::move(found.band);
    found.band.values = part.band.values;
    return part;
  }

  const SupernodalStructure matrix_;
  const SlicingOptions options_;
  const int workers_;  // the threads that have a band each
  absl::Mutex mu_;
  ShiftGrid grid_;  // by one thread at a time, under mu_
  // The band that is planned next, left to whoever asks without a bound.
  std::optional<PlannedBand> cluster_;
  std::vector<std::unique_ptr<FoundBand>> bands_;
  size_t certified_ =
      0;  // bands that were handed on, without their vectors now
  absl::Status status_;
  size_t sound_ = 0;  // bands before the first that failed
  int finished_ = 0;
  std::atomic<double> done_{0};
};

}  // namespace

absl::StatusOr<std::unique_ptr<SpectrumSlicer>> SpectrumSlicer::Create(
    const Eigen::SparseMatrix<double>& matrix, const double* positions,
    int most_pairs, const SlicingOptions& options, const CancelToken& cancel) {
  try {
    MARROW_ASSIGN_OR_RETURN(
        SupernodalStructure structure,
        AnalyseStructure(matrix, positions, options.max_factor_bytes,
                         options.threads, cancel));
    return std::make_unique<Slicer>(std::move(structure), most_pairs, options);
  } catch (const std::bad_alloc&) {
    return OutOfMemory(static_cast<int>(matrix.rows()));
  }
}

}  // namespace marrow
