#include "client/call_group.h"

namespace marrow::client {

CallGroup::Context::Context(CallGroup& group, absl::Time deadline)
    : group_(group) {
  if (deadline != absl::InfiniteFuture()) {
    context_.set_deadline(absl::ToChronoTime(deadline));
  }
  absl::MutexLock lock(&group_.mutex_);
  group_.contexts_.insert(&context_);
  // gRPC remembers a cancellation that comes before the call.
  if (group_.cancelled_) context_.TryCancel();
}

CallGroup::Context::~Context() {
  absl::MutexLock lock(&group_.mutex_);
  group_.contexts_.erase(&context_);
}

void CallGroup::Cancel() {
  absl::MutexLock lock(&mutex_);
  cancelled_ = true;
  for (grpc::ClientContext* context : contexts_) context->TryCancel();
}

}  // namespace marrow::client
