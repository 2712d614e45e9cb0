#include "server/spectrum_cache.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <utility>

#include "absl/time/time.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const absl::Duration kPollInterval = absl::Milliseconds(20);

// What an entry takes besides its numbers.
constexpr uint64_t kEntryOverhead = 512;

// Whether these are all pairs up to `bound` and one beyond, or `count` of them.
bool Reach(const EigenPairs& pairs, uint32_t count, double bound) {
  const uint32_t there = pairs.NumPairs();
  return pairs.complete || there > count ||
         (there > 0 && pairs.eigenvalues[there - 1] > bound) ||
         (std::isfinite(bound) && pairs.cluster_end > count);
}

// Forwards only what rises: a caller that waited for one computation and then
// does its own would otherwise see the share fall back to 0.
class RisingProgress {
 public:
  explicit RisingProgress(const ProgressCallback& sink) : sink_(sink) {}
  void operator()(double fraction) {
    if (fraction <= reported_ || !sink_) return;
    reported_ = fraction;
    sink_(fraction);
  }

 private:
  const ProgressCallback& sink_;
  double reported_ = 0;
};

}  // namespace

// One computation and those who wait for it. `result` is set once, under the
// cache's lock, and `done` signalled.
struct SpectrumCache::Flight {
  std::atomic<double> fraction{0};
  mutable absl::CondVar done;
  std::optional<Result> result;
};

class SpectrumCache::Stream : public EigenPairStream {
 public:
  // Of one of the uses the stream is told of, or of none that anyone asks for.
  Stream(SpectrumCache& cache, const CanonicalMesh& mesh, uint32_t count,
         SpectrumUse* use)
      : cache_(cache),
        mesh_(mesh),
        key_(KeyOf(mesh, count)),
        shared_(cache.solver_->GivesSharedPairs(mesh, key_.count)),
        use_(use != nullptr ? *use : own_use_) {
    use_ = SpectrumUse();
    use_.eigen_pairs = key_.count;
  }

  Result UpTo(double bound, const CancelToken& cancel,
              const ProgressCallback& progress) override {
    MARROW_ASSIGN_OR_RETURN(const auto pairs, Obtain(bound, cancel, progress));
    use_.laplacian = pairs->laplacian;
    return Shortened(pairs);
  }

 private:
  // UpTo(), perhaps with more pairs than anyone is to see.
  Result Obtain(double bound, const CancelToken& cancel,
                const ProgressCallback& progress) {
    RisingProgress rising(progress);
    std::shared_ptr<Flight> flight;
    {
      absl::MutexLock lock(&cache_.mu_);
      while (flight == nullptr) {
        if (const auto held = cache_.HolderFor(key_, shared_, bound))
          return cache_.entries_.Find(*held);
        auto [it, inserted] = cache_.flights_.try_emplace(key_);
        if (inserted) {
          flight = it->second = std::make_shared<Flight>();
          break;
        }
        const std::shared_ptr<Flight> other = it->second;
        MARROW_RETURN_IF_ERROR(WaitFor(*other, cancel, rising));
        if (!other->result->ok()) {
          if (absl::IsCancelled(other->result->status())) continue;
          return other->result->status();
        }
        if (Reach(***other->result, key_.count, bound)) return **other->result;
      }
    }
    return Compute(*flight, bound, cancel, rising);
  }

  // As many as the stream was opened for. A copy is made once of each entry.
  Result Shortened(std::shared_ptr<const EigenPairs> pairs) {
    if (pairs->NumPairs() <= key_.count + 1) return pairs;
    if (longer_ != pairs) {
      try {
        shortened_ = std::make_shared<const EigenPairs>(
            FirstPairs(*pairs, key_.count + 1));
      } catch (const std::bad_alloc&) {
        return absl::ResourceExhaustedError("out of memory for eigen-pairs");
      }
      longer_ = std::move(pairs);
    }
    return shortened_;
  }

  absl::Status WaitFor(const Flight& other, const CancelToken& cancel,
                       RisingProgress& rising)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(cache_.mu_) {
    if (use_.outcome == CacheOutcome::kHit)
      use_.outcome = CacheOutcome::kJoined;
    while (!other.result.has_value()) {
      other.done.WaitWithTimeout(&cache_.mu_, kPollInterval);
      if (cancel.IsCancelled()) return cancel.Check();
      cache_.mu_.Unlock();
      rising(other.fraction.load(std::memory_order_relaxed));
      cache_.mu_.Lock();
    }
    return absl::OkStatus();
  }

  Result Compute(Flight& flight, double bound, const CancelToken& cancel,
                 RisingProgress& rising) {
    use_.outcome = CacheOutcome::kMiss;
    Result result = absl::InternalError("the eigensolver gave nothing");
    try {
      if (solver_ == nullptr) {
        ++use_.solver_runs;
        solver_ = cache_.solver_->Open(mesh_, key_.count);
      }
      result = solver_->UpTo(bound, cancel, [&](double fraction) {
        flight.fraction.store(fraction, std::memory_order_relaxed);
        rising(fraction);
      });
    } catch (const std::bad_alloc&) {
      result = absl::ResourceExhaustedError("out of memory for eigen-pairs");
    }
    cache_.Land(key_, flight, result);
    if (!result.ok() || Reach(**result, key_.count, kInfinity)) solver_.reset();
    return result;
  }

  SpectrumCache& cache_;
  const CanonicalMesh& mesh_;
  const Key key_;
  const bool shared_;
  SpectrumUse own_use_;
  SpectrumUse& use_;
  std::unique_ptr<EigenPairStream> solver_;  // null before and after its work
  // An entry with more pairs than may be given, and those that may.
  std::shared_ptr<const EigenPairs> longer_, shortened_;
};

void SpectrumUse::Add(const SpectrumUse& other) {
  if (outcome != CacheOutcome::kMiss && other.outcome != CacheOutcome::kHit)
    outcome = other.outcome;
  solver_runs += other.solver_runs;
  eigen_pairs = std::max(eigen_pairs, other.eigen_pairs);
  laplacian.Add(other.laplacian);
}

SpectrumCache::SpectrumCache(std::shared_ptr<EigenPairSource> solver,
                             uint64_t budget_bytes)
    : solver_(std::move(solver)), entries_(budget_bytes) {}

// A mesh of n vertices has n pairs: any count from n - 1 is one request.
SpectrumCache::Key SpectrumCache::KeyOf(const CanonicalMesh& mesh,
                                        uint32_t count) {
  const uint32_t vertices = mesh.mesh.NumVertices();
  const uint32_t most = std::max(vertices, 3u) - 1;
  return {mesh.geometry_digest, std::min(count, most)};
}

std::optional<SpectrumCache::Key> SpectrumCache::HolderFor(const Key& key,
                                                           bool shared,
                                                           double bound) {
  for (const Key& held : {Key{key.geometry, 0}, key}) {
    if (held.count == 0 && !shared) continue;
    const auto pairs = entries_.Peek(held);
    if (pairs != nullptr && Reach(*pairs, key.count, bound)) return held;
  }
  return std::nullopt;
}

absl::StatusOr<std::shared_ptr<const EigenPairs>> SpectrumCache::Get(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress) {
  SpectrumUse use;
  return Get(mesh, count, cancel, progress, use);
}

absl::StatusOr<std::shared_ptr<const EigenPairs>> SpectrumCache::Get(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress, SpectrumUse& use) {
  return Open(mesh, count, use)->UpTo(kInfinity, cancel, progress);
}

std::unique_ptr<EigenPairStream> SpectrumCache::Open(const CanonicalMesh& mesh,
                                                     uint32_t count) {
  return std::make_unique<Stream>(*this, mesh, count, nullptr);
}

std::unique_ptr<EigenPairStream> SpectrumCache::Open(const CanonicalMesh& mesh,
                                                     uint32_t count,
                                                     SpectrumUse& use) {
  return std::make_unique<Stream>(*this, mesh, count, &use);
}

void SpectrumCache::Land(const Key& key, Flight& flight, Result result) {
  absl::MutexLock lock(&mu_);
  if (result.ok()) {
    const EigenPairs& pairs = **result;
    const Key holder{key.geometry, pairs.for_any_count ? 0 : key.count};
    const auto entry = entries_.Peek(holder);
    const auto extent = [](const EigenPairs& of) {
      return std::pair(of.NumPairs(), of.cluster_end);
    };
    if (entry == nullptr || extent(*entry) < extent(pairs))
      entries_.Insert(holder, *result, pairs.Bytes() + kEntryOverhead);
  }
  flight.result = std::move(result);
  flights_.erase(key);
  flight.done.SignalAll();
}

bool SpectrumCache::Contains(const CanonicalMesh& mesh, uint32_t count) {
  absl::MutexLock lock(&mu_);
  const Key key = KeyOf(mesh, count);
  return HolderFor(key, solver_->GivesSharedPairs(mesh, key.count), kInfinity)
      .has_value();
}

uint64_t SpectrumCache::bytes() {
  absl::MutexLock lock(&mu_);
  return entries_.bytes();
}

}  // namespace marrow
