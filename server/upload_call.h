// One upload: a header, then chunks.
#ifndef MARROW_SERVER_UPLOAD_CALL_H_
#define MARROW_SERVER_UPLOAD_CALL_H_

#include <grpcpp/grpcpp.h>

#include <memory>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "marrow/v1/mesh_store_service.pb.h"
#include "server/mesh_store.h"
#include "server/service_context.h"

namespace marrow {

// Deletes itself when gRPC is done with it.
class UploadCall final : public grpc::ServerReadReactor<v1::UploadMeshRequest> {
 public:
  UploadCall(ServiceContext& context, grpc::CallbackServerContext& call,
             v1::UploadMeshResponse* response);

  // Called once, before the reactor is handed to gRPC.
  void Begin();

  void OnReadDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  class State;
  const std::shared_ptr<State> state_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_UPLOAD_CALL_H_
