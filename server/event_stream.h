// A stream of a call: the reader of a job's log.
#ifndef MARROW_SERVER_EVENT_STREAM_H_
#define MARROW_SERVER_EVENT_STREAM_H_

#include <grpcpp/grpcpp.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "core/base/status_macros.h"
#include "server/job.h"
#include "server/service_context.h"
#include "server/status.h"

namespace marrow {

// What gRPC, the job and the clock share of a stream. It outlives the reactor
// as long as one of them still holds it.
//
// Invariants: `reactor_` is null once Finish() was called on it, and is not
// used after; at most one write is under way, and `current_` is what it
// writes; Finish() waits for that write.
template <typename Event>
class StreamState final
    : public JobListener,
      public Tickable,
      public std::enable_shared_from_this<StreamState<Event>> {
 public:
  using Reactor = grpc::ServerWriteReactor<Event>;
  using Table = JobTable<Event>;
  using EventPtr = std::shared_ptr<const Event>;
  // What a stream that joined another's job reads of an event.
  using Adapt = EventPtr (*)(EventPtr);

  StreamState(ServiceContext& context, grpc::CallbackServerContext& call,
              std::string method, Reactor* reactor)
      : context_(context),
        call_(call),
        record_(context, call, std::move(method)),
        reactor_(reactor) {}

  // Called at most once, before anything else happens. Either begins to read
  // `job`, which this listens to already, or ends with `refused`.
  void Begin(absl::StatusOr<std::shared_ptr<Job<Event>>> job, bool joined,
             Adapt adapt) {
    absl::MutexLock lock(&mu_);
    if (job.ok()) {
      job_ = *std::move(job);
      record_.Describe("job", job_->id());
      if (joined) adapt_ = adapt;
      if (closing_.has_value()) job_->Leave(this);
    } else if (!closing_.has_value()) {
      closing_ = job.status();
    }
    begun_ = true;
    PumpLocked();
  }

  void Describe(std::string name, std::string value) {
    absl::MutexLock lock(&mu_);
    record_.Describe(std::move(name), std::move(value));
  }

  void OnJobChanged() override {
    absl::MutexLock lock(&mu_);
    PumpLocked();
  }

  void OnWriteDone(bool ok) {
    absl::MutexLock lock(&mu_);
    writing_ = false;
    current_.reset();
    if (!ok) CloseLocked(CallCancelled());
    PumpLocked();
  }

  void OnCancel() {
    absl::MutexLock lock(&mu_);
    CloseLocked(CallCancelled());
    PumpLocked();
  }

  void Tick(Clock::time_point now) override {
    absl::MutexLock lock(&mu_);
    if (reactor_ == nullptr) return;
    if (record_.Expired(now)) {
      CloseLocked(DefaultDeadlineExceeded(context_.options));
    }
    if (writing_ && now - write_began_ > context_.options.write_stall_limit) {
      CloseLocked(absl::CancelledError("the client reads nothing"));
      call_.TryCancel();
    }
    PumpLocked();
  }

 private:
  // Stops reading. The first reason stands.
  void CloseLocked(absl::Status reason) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    if (closing_.has_value()) return;
    closing_ = std::move(reason);
    if (job_ != nullptr) job_->Leave(this);
  }

  void PumpLocked() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    if (!begun_ || reactor_ == nullptr || writing_) return;
    if (closing_.has_value()) return FinishLocked(*closing_);
    typename Job<Event>::Reading next = job_->Read(next_sequence_);
    if (next.event != nullptr) return WriteLocked(std::move(next.event));
    if (next.end.has_value()) FinishLocked(*next.end);
  }

  void WriteLocked(EventPtr event) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    ++next_sequence_;
    current_ = adapt_ == nullptr ? std::move(event) : adapt_(std::move(event));
    writing_ = true;
    write_began_ = Clock::now();
    reactor_->StartWrite(current_.get());
  }

  void FinishLocked(const absl::Status& status)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    if (job_ != nullptr) job_->Leave(this);
    const grpc::Status grpc_status = ToGrpcStatus(status);
    record_.Finished(grpc_status);
    std::exchange(reactor_, nullptr)->Finish(grpc_status);
  }

  ServiceContext& context_;
  grpc::CallbackServerContext& call_;

  absl::Mutex mu_;
  CallRecord record_ ABSL_GUARDED_BY(mu_);
  Reactor* reactor_ ABSL_GUARDED_BY(mu_);
  std::shared_ptr<Job<Event>> job_ ABSL_GUARDED_BY(mu_);
  Adapt adapt_ ABSL_GUARDED_BY(mu_) = nullptr;
  bool begun_ ABSL_GUARDED_BY(mu_) = false;
  uint64_t next_sequence_ ABSL_GUARDED_BY(mu_) = 1;
  EventPtr current_ ABSL_GUARDED_BY(mu_);
  bool writing_ ABSL_GUARDED_BY(mu_) = false;
  Clock::time_point write_began_ ABSL_GUARDED_BY(mu_);
  std::optional<absl::Status> closing_ ABSL_GUARDED_BY(mu_);
};

// Deletes itself when gRPC is done with it.
template <typename Event>
class EventStream final : public grpc::ServerWriteReactor<Event> {
 public:
  EventStream(ServiceContext& context, grpc::CallbackServerContext& call,
              std::string method)
      : state_(std::make_shared<StreamState<Event>>(context, call,
                                                    std::move(method), this)) {
    context.ticker.Add(state_);
  }

  const std::shared_ptr<StreamState<Event>>& state() const { return state_; }

  void OnWriteDone(bool ok) override { state_->OnWriteDone(ok); }
  void OnCancel() override { state_->OnCancel(); }
  void OnDone() override { delete this; }

 private:
  const std::shared_ptr<StreamState<Event>> state_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_EVENT_STREAM_H_
