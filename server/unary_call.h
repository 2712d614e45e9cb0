// A call with one answer that a compute thread works out.
#ifndef MARROW_SERVER_UNARY_CALL_H_
#define MARROW_SERVER_UNARY_CALL_H_

#include <grpcpp/grpcpp.h>

#include <memory>
#include <string>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "core/base/cancel_token.h"
#include "server/service_context.h"
#include "server/status.h"

namespace marrow {

// What gRPC, the clock and the compute thread share of a call. The first to
// finish it wins; the others find it finished. `response_` and `reactor_` are
// gRPC's, and not used after that.
template <typename Response>
class UnaryState final : public Tickable {
 public:
  UnaryState(ServiceContext& context, grpc::CallbackServerContext& call,
             std::string method, Response* response,
             grpc::ServerUnaryReactor* reactor)
      : context_(context),
        record_(context, call, std::move(method)),
        response_(response),
        reactor_(reactor) {}

  const std::shared_ptr<CancelToken>& cancel() const { return cancel_; }

  void Describe(std::string name, std::string value) {
    absl::MutexLock lock(&mu_);
    record_.Describe(std::move(name), std::move(value));
  }

  void Finish(absl::StatusOr<Response> result) {
    absl::MutexLock lock(&mu_);
    if (reactor_ == nullptr) return;
    cancel_->Cancel();
    const grpc::Status status = ToGrpcStatus(result.status());
    if (result.ok()) *response_ = *std::move(result);
    record_.Finished(status);
    std::exchange(reactor_, nullptr)->Finish(status);
  }

  void Tick(Clock::time_point now) override {
    bool expired = false;
    {
      absl::MutexLock lock(&mu_);
      expired = record_.Expired(now);
    }
    if (expired) Finish(DefaultDeadlineExceeded(context_.options));
  }

 private:
  ServiceContext& context_;
  const std::shared_ptr<CancelToken> cancel_ = std::make_shared<CancelToken>();
  absl::Mutex mu_;
  CallRecord record_ ABSL_GUARDED_BY(mu_);
  Response* const response_ ABSL_PT_GUARDED_BY(mu_);
  grpc::ServerUnaryReactor* reactor_ ABSL_GUARDED_BY(mu_);
};

// Deletes itself when gRPC is done with it.
template <typename Response>
class UnaryCall final : public grpc::ServerUnaryReactor {
 public:
  UnaryCall(ServiceContext& context, grpc::CallbackServerContext& call,
            std::string method, Response* response)
      : state_(std::make_shared<UnaryState<Response>>(
            context, call, std::move(method), response, this)) {
    context.ticker.Add(state_);
  }

  const std::shared_ptr<UnaryState<Response>>& state() const { return state_; }

  void OnCancel() override { state_->Finish(CallCancelled()); }
  void OnDone() override { delete this; }

 private:
  const std::shared_ptr<UnaryState<Response>> state_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_UNARY_CALL_H_
