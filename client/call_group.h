// Calls that are cancelled together.
#ifndef MARROW_CLIENT_CALL_GROUP_H_
#define MARROW_CLIENT_CALL_GROUP_H_

#include <grpcpp/client_context.h>

#include <set>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"

namespace marrow::client {

// Thread safe. Must outlive the calls in it.
class CallGroup {
 public:
  // A call's context, in the group while it lives.
  class Context {
   public:
    // An infinite deadline is none.
    Context(CallGroup& group, absl::Time deadline);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    grpc::ClientContext* get() { return &context_; }

   private:
    CallGroup& group_;
    grpc::ClientContext context_;
  };

  // Cancels the calls in the group and every one that comes later.
  void Cancel();

 private:
  absl::Mutex mutex_;
  bool cancelled_ ABSL_GUARDED_BY(mutex_) = false;
  std::set<grpc::ClientContext*> contexts_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_CALL_GROUP_H_
