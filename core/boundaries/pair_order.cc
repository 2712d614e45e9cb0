#include "core/boundaries/pair_order.h"

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/cleanup/cleanup.h"
#include "absl/synchronization/mutex.h"

namespace marrow {
namespace {

// A pair waits for the latest before it of either piece.
class PairQueue {
 public:
  explicit PairQueue(std::span<const PiecePair> pairs)
      : waits_for_(pairs.size(), 0),
        followers_(pairs.size()),
        left_(pairs.size()) {
    std::map<uint32_t, uint32_t> latest;  // pair of a piece
    for (uint32_t i = 0; i < pairs.size(); ++i) {
      for (uint32_t piece : {pairs[i].first, pairs[i].second}) {
        const auto [it, is_first] = latest.try_emplace(piece, i);
        if (is_first) continue;
        followers_[it->second].push_back(i);
        it->second = i;
        ++waits_for_[i];
      }
      if (waits_for_[i] == 0) ready_.insert(i);
    }
  }

  // The first that may begin, once there is one; none where all have begun.
  std::optional<uint32_t> Take() {
    absl::MutexLock lock(&mu_);
    mu_.Await(absl::Condition(this, &PairQueue::HasReadyOrEnds));
    if (ready_.empty()) return std::nullopt;
    --left_;
    return ready_.extract(ready_.begin()).value();
  }

  void Done(uint32_t pair) {
    absl::MutexLock lock(&mu_);
    for (uint32_t next : followers_[pair])
      if (--waits_for_[next] == 0) ready_.insert(next);
  }

 private:
  // The first of those left is ready, unless one that runs holds it up.
  bool HasReadyOrEnds() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    return !ready_.empty() || left_ == 0;
  }

  absl::Mutex mu_;
  std::vector<uint32_t> waits_for_ ABSL_GUARDED_BY(mu_);
  std::vector<std::vector<uint32_t>> followers_;
  std::set<uint32_t> ready_ ABSL_GUARDED_BY(mu_);
  size_t left_ ABSL_GUARDED_BY(mu_);
};

}  // namespace

void ForPairs(Team& team, std::span<const PiecePair> pairs,
              const std::function<void(int, const PiecePair&)>& body) {
  PairQueue queue(pairs);
  team.For(team.threads(), [&](int worker) {
    while (const std::optional<uint32_t> i = queue.Take()) {
      // Even where memory has run out, or the others would wait for ever.
      const absl::Cleanup done = [&] { queue.Done(*i); };
      body(worker, pairs[*i]);
    }
  });
}

}  // namespace marrow
