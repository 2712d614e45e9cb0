#include "server/compute_pool.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"

namespace marrow {
namespace {

// The pool whose task this thread runs, until it counts as idle.
thread_local ComputePool* busy_for = nullptr;

}  // namespace

ComputePool::ComputePool(int threads, int max_queued)
    : max_queued_(static_cast<size_t>(max_queued)),
      idle_(static_cast<size_t>(threads)) {
  for (int i = 0; i < threads; ++i) {
    threads_.emplace_back([this] { Work(); });
  }
}

ComputePool::~ComputePool() {
  {
    absl::MutexLock lock(&mu_);
    stopping_ = true;
  }
  for (std::thread& thread : threads_) thread.join();
}

absl::Status ComputePool::Submit(std::shared_ptr<const CancelToken> cancel,
                                 std::function<void()> run) {
  std::vector<Task> cancelled;
  bool accepted = false;
  {
    absl::MutexLock lock(&mu_);
    // What idle threads are about to take does not wait.
    if (queue_.size() >= max_queued_ + idle_) cancelled = TakeCancelled();
    accepted = queue_.size() < max_queued_ + idle_;
    if (accepted) queue_.push_back({std::move(cancel), std::move(run)});
  }
  for (Task& task : cancelled) task.run();
  if (accepted) return absl::OkStatus();
  return WithReason(
      absl::UnavailableError(absl::StrCat(
          "all compute threads are busy and ", max_queued_,
          " calls wait already; try again later or on another server")),
      kReasonOverloaded);
}

std::vector<ComputePool::Task> ComputePool::TakeCancelled() {
  const auto first = std::stable_partition(
      queue_.begin(), queue_.end(),
      [](const Task& task) { return !task.cancel->IsCancelled(); });
  std::vector<Task> cancelled(std::make_move_iterator(first),
                              std::make_move_iterator(queue_.end()));
  queue_.erase(first, queue_.end());
  return cancelled;
}

bool ComputePool::HasWorkOrStops() const {
  return stopping_ || !queue_.empty();
}

void ComputePool::Work() {
  while (true) {
    Task task;
    {
      absl::MutexLock lock(&mu_);
      mu_.Await(absl::Condition(this, &ComputePool::HasWorkOrStops));
      if (queue_.empty()) return;
      task = std::move(queue_.front());
      queue_.pop_front();
      --idle_;
    }
    busy_for = this;
    task.run();
    task = Task();  // what it holds goes before the thread counts as idle
    CountAsIdle();
  }
}

void ComputePool::CountAsIdle() {
  ComputePool* pool = std::exchange(busy_for, nullptr);
  if (pool == nullptr) return;
  absl::MutexLock lock(&pool->mu_);
  ++pool->idle_;
}

}  // namespace marrow
