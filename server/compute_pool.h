// The threads that compute, so that gRPC's never do.
#ifndef MARROW_SERVER_COMPUTE_POOL_H_
#define MARROW_SERVER_COMPUTE_POOL_H_

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "core/base/cancel_token.h"

namespace marrow {

// A fixed number of threads and a bounded queue, first in, first out. Thread
// safe.
class ComputePool {
 public:
  ComputePool(int threads, int max_queued);
  // Runs what is queued (cancel it before to be quick) and joins the threads.
  ~ComputePool();
  ComputePool(const ComputePool&) = delete;
  ComputePool& operator=(const ComputePool&) = delete;

  // Has `run` called once, always, if the answer is OK; otherwise UNAVAILABLE
  // with reason OVERLOADED, and `run` is not called. REQUIRES: `run` returns
  // at once where `cancel` is cancelled; tasks that are so leave a full queue
  // by being run on the thread that submits another.
  absl::Status Submit(std::shared_ptr<const CancelToken> cancel,
                      std::function<void()> run);

  // For a task that is about to give its answer away: its thread counts as idle
  // from here on, so that who has the answer is not refused for it. Nothing on
  // a thread of no pool.
  static void CountAsIdle();

 private:
  struct Task {
    std::shared_ptr<const CancelToken> cancel;
    std::function<void()> run;
  };

  void Work();
  bool HasWorkOrStops() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_);
  std::vector<Task> TakeCancelled() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_);

  const size_t max_queued_;
  absl::Mutex mu_;
  std::deque<Task> queue_ ABSL_GUARDED_BY(mu_);
  size_t idle_ ABSL_GUARDED_BY(mu_) = 0;
  bool stopping_ ABSL_GUARDED_BY(mu_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_COMPUTE_POOL_H_
