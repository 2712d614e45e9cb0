// A piece of work that several streams may watch.
//
// A job is an append-only log of events. Whoever watches reads it from the
// first event on, at its own pace, and is told when there is more; so a late
// watcher sees what an early one saw, and a slow one holds nobody up. A job
// that nobody watches any more is cancelled.
#ifndef MARROW_SERVER_JOB_H_
#define MARROW_SERVER_JOB_H_

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "core/base/cancel_token.h"
#include "marrow/v1/mesh.pb.h"
#include "server/compute_pool.h"
#include "server/ticker.h"

namespace marrow {

class JobListener {
 public:
  virtual ~JobListener() = default;
  // There is more to read. Called without a lock of the job's held.
  virtual void OnJobChanged() = 0;
};

// Event is a message with `sequence` and `progress`. Thread safe; those who
// append are one thread at a time.
//
// Invariants: sequences in the log run from 1 without gaps; nothing is
// appended once `end_` is set; a job that is cancelled or ended takes no
// listeners; whoever reads the end finds its compute thread idle.
template <typename Event>
class Job : public Tickable {
 public:
  using EventPtr = std::shared_ptr<const Event>;
  // What a reader finds at a sequence: an event, or the job's end, or, where
  // neither is set, nothing yet.
  struct Reading {
    EventPtr event;
    std::optional<absl::Status> end;
  };

  Job(std::string id, std::chrono::milliseconds progress_interval)
      : id_(std::move(id)),
        progress_interval_(progress_interval),
        cancel_(std::make_shared<CancelToken>()) {}

  const std::string& id() const { return id_; }
  Clock::time_point created() const { return created_; }
  const std::shared_ptr<CancelToken>& cancel() const { return cancel_; }

  // False where it is too late: the caller needs a job of its own.
  bool Join(std::shared_ptr<JobListener> listener) {
    absl::MutexLock lock(&mu_);
    if (end_.has_value() || cancel_->IsCancelled()) return false;
    listeners_.push_back(std::move(listener));
    return true;
  }

  // Cancels the job where the last listener leaves before its end.
  void Leave(const JobListener* listener) {
    absl::MutexLock lock(&mu_);
    std::erase_if(listeners_,
                  [&](const auto& l) { return l.get() == listener; });
    if (listeners_.empty() && !end_.has_value()) cancel_->Cancel();
  }

  // Gives the event its sequence. False where the job is cancelled.
  bool Append(Event event) {
    {
      absl::MutexLock lock(&mu_);
      AppendLocked(std::move(event));
    }
    Notify();
    return !cancel_->IsCancelled();
  }

  // Appends `last` and ends the job with OK, with nothing in between.
  void Complete(Event last) {
    ComputePool::CountAsIdle();
    {
      absl::MutexLock lock(&mu_);
      AppendLocked(std::move(last));
      end_ = absl::OkStatus();
    }
    Notify();
  }

  // Ends the job with `count` events that `make` (index from 0) makes anew for
  // every reader, for what is too big to be kept. `make` must be thread safe.
  void CompleteLazily(uint64_t count, std::function<Event(uint64_t)> make) {
    ComputePool::CountAsIdle();
    {
      absl::MutexLock lock(&mu_);
      lazy_count_ = count;
      make_ = std::move(make);
      end_ = absl::OkStatus();
    }
    Notify();
  }

  // Ends the job with an error, unless it has ended.
  void Fail(absl::Status error) {
    ComputePool::CountAsIdle();
    {
      absl::MutexLock lock(&mu_);
      if (end_.has_value()) return;
      end_ = std::move(error);
    }
    Notify();
  }

  // Appends a progress event, unless the last one is recent and of the same
  // stage. A fraction that falls is held. False where the job is cancelled.
  bool Progress(v1::Stage stage, double fraction) {
    bool appended = false;
    {
      absl::MutexLock lock(&mu_);
      fraction_ = std::clamp(fraction, fraction_, 1.0);
      const Clock::time_point now = Clock::now();
      if (stage != stage_ || now - last_event_ >= kMinProgressInterval) {
        stage_ = stage;
        AppendProgressLocked();
        appended = true;
      }
    }
    if (appended) Notify();
    return !cancel_->IsCancelled();
  }

  // REQUIRES: sequence >= 1.
  Reading Read(uint64_t sequence) const {
    std::function<Event(uint64_t)> make;
    uint64_t index = 0;
    {
      absl::MutexLock lock(&mu_);
      if (sequence <= log_.size()) return {log_[sequence - 1], std::nullopt};
      index = sequence - log_.size() - 1;
      if (index >= lazy_count_) return {nullptr, end_};
      make = make_;
    }
    Event event = make(index);
    event.set_sequence(sequence);
    return {std::make_shared<const Event>(std::move(event)), std::nullopt};
  }

  // A sign of life where the work has long been silent.
  void Tick(Clock::time_point now) override {
    {
      absl::MutexLock lock(&mu_);
      if (end_.has_value() || now - last_event_ < progress_interval_) return;
      AppendProgressLocked();
    }
    Notify();
  }

 private:
  static constexpr std::chrono::milliseconds kMinProgressInterval{250};

  void AppendLocked(Event event) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    if (end_.has_value()) return;
    event.set_sequence(log_.size() + 1);
    log_.push_back(std::make_shared<const Event>(std::move(event)));
    last_event_ = Clock::now();
  }

  void AppendProgressLocked() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    Event event;
    event.mutable_progress()->set_stage(stage_);
    event.mutable_progress()->set_fraction(fraction_);
    AppendLocked(std::move(event));
  }

  void Notify() {
    std::vector<std::shared_ptr<JobListener>> listeners;
    {
      absl::MutexLock lock(&mu_);
      listeners = listeners_;
    }
    for (const auto& listener : listeners) listener->OnJobChanged();
  }

  const std::string id_;
  const std::chrono::milliseconds progress_interval_;
  const Clock::time_point created_ = Clock::now();
  const std::shared_ptr<CancelToken> cancel_;

  mutable absl::Mutex mu_;
  std::vector<EventPtr> log_ ABSL_GUARDED_BY(mu_);
  uint64_t lazy_count_ ABSL_GUARDED_BY(mu_) = 0;
  std::function<Event(uint64_t)> make_ ABSL_GUARDED_BY(mu_);
  std::optional<absl::Status> end_ ABSL_GUARDED_BY(mu_);
  std::vector<std::shared_ptr<JobListener>> listeners_ ABSL_GUARDED_BY(mu_);
  v1::Stage stage_ ABSL_GUARDED_BY(mu_) = v1::STAGE_UNSPECIFIED;
  double fraction_ ABSL_GUARDED_BY(mu_) = 0;
  Clock::time_point last_event_ ABSL_GUARDED_BY(mu_) = created_;
};

// The jobs under way, so that equal requests share one. Thread safe.
template <typename Event>
class JobTable {
 public:
  using JobPtr = std::shared_ptr<Job<Event>>;
  struct Membership {
    JobPtr job;
    bool is_new;
  };

  // Makes `listener` a listener of the job of this key, which `create` makes
  // where there is none that can be joined.
  Membership Join(const std::string& key,
                  const std::shared_ptr<JobListener>& listener,
                  const std::function<JobPtr()>& create) {
    absl::MutexLock lock(&mu_);
    JobPtr& slot = jobs_[key];
    if (slot != nullptr && slot->Join(listener)) return {slot, false};
    slot = create();
    slot->Join(listener);
    return {slot, true};
  }

  // Forgets the job, unless a newer one has taken its key.
  void Remove(const std::string& key, const Job<Event>* job) {
    absl::MutexLock lock(&mu_);
    auto it = jobs_.find(key);
    if (it != jobs_.end() && it->second.get() == job) jobs_.erase(it);
  }

 private:
  absl::Mutex mu_;
  std::map<std::string, JobPtr> jobs_ ABSL_GUARDED_BY(mu_);
};

}  // namespace marrow

#endif  // MARROW_SERVER_JOB_H_
