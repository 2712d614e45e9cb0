#include "server/spectrum_cache.h"

#include <algorithm>
#include <atomic>
#include <new>
#include <optional>
#include <utility>

#include "absl/time/time.h"

namespace marrow {
namespace {

const absl::Duration kPollInterval = absl::Milliseconds(20);

// What an entry takes besides its numbers.
constexpr uint64_t kEntryOverhead = 512;

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
  absl::CondVar done;
  std::optional<Result> result;
};

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

absl::StatusOr<std::shared_ptr<const EigenPairs>> SpectrumCache::Get(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress) {
  SpectrumUse use;
  return Get(mesh, count, cancel, progress, use);
}

absl::StatusOr<std::shared_ptr<const EigenPairs>> SpectrumCache::Get(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress, SpectrumUse& use) {
  const Key key = KeyOf(mesh, count);
  RisingProgress rising(progress);
  use = SpectrumUse();
  const auto take = [&use](const std::shared_ptr<const EigenPairs>& pairs) {
    use.eigen_pairs = pairs->NumPairs() - 1;
    return pairs;
  };
  std::shared_ptr<Flight> flight;
  {
    absl::MutexLock lock(&mu_);
    while (flight == nullptr) {
      if (auto pairs = entries_.Find(key)) return take(pairs);
      auto [it, inserted] = flights_.try_emplace(key);
      if (inserted) {
        flight = it->second = std::make_shared<Flight>();
        break;
      }
      const std::shared_ptr<Flight> other = it->second;
      use.outcome = CacheOutcome::kJoined;
      while (!other->result.has_value()) {
        other->done.WaitWithTimeout(&mu_, kPollInterval);
        if (cancel.IsCancelled()) return cancel.Check();
        mu_.Unlock();
        rising(other->fraction.load(std::memory_order_relaxed));
        mu_.Lock();
      }
      if (other->result->ok()) return take(**other->result);
      if (!absl::IsCancelled(other->result->status())) {
        return other->result->status();
      }
    }
  }
  use.outcome = CacheOutcome::kMiss;
  use.solver_runs = 1;
  Result result = Lead(key, *flight, mesh, cancel,
                       [&rising](double fraction) { rising(fraction); });
  if (result.ok()) take(*result);
  return result;
}

SpectrumCache::Result SpectrumCache::Lead(const Key& key, Flight& flight,
                                          const CanonicalMesh& mesh,
                                          const CancelToken& cancel,
                                          const ProgressCallback& progress) {
  Result result = absl::InternalError("the eigensolver gave nothing");
  try {
    result = solver_->Get(
        mesh, key.count, cancel, [&flight, &progress](double fraction) {
          flight.fraction.store(fraction, std::memory_order_relaxed);
          progress(fraction);
        });
  } catch (const std::bad_alloc&) {
    result = absl::ResourceExhaustedError("out of memory for eigen-pairs");
  }
  absl::MutexLock lock(&mu_);
  if (result.ok()) {
    entries_.Insert(key, *result, (*result)->Bytes() + kEntryOverhead);
  }
  flight.result = result;
  flights_.erase(key);
  flight.done.SignalAll();
  return result;
}

bool SpectrumCache::Contains(const CanonicalMesh& mesh, uint32_t count) {
  absl::MutexLock lock(&mu_);
  return entries_.Contains(KeyOf(mesh, count));
}

uint64_t SpectrumCache::bytes() {
  absl::MutexLock lock(&mu_);
  return entries_.bytes();
}

}  // namespace marrow
