#ifndef MARROW_SERVER_MESH_STORE_SERVICE_H_
#define MARROW_SERVER_MESH_STORE_SERVICE_H_

#include <grpcpp/grpcpp.h>

#include "marrow/v1/mesh_store_service.grpc.pb.h"
#include "server/service_context.h"

namespace marrow {

// Thread safe.
class MeshStoreService final : public v1::MeshStoreService::CallbackService {
 public:
  explicit MeshStoreService(ServiceContext& context) : context_(context) {}

  grpc::ServerUnaryReactor* FindMissingMeshes(
      grpc::CallbackServerContext* call,
      const v1::FindMissingMeshesRequest* request,
      v1::FindMissingMeshesResponse* response) override;

  grpc::ServerReadReactor<v1::UploadMeshRequest>* UploadMesh(
      grpc::CallbackServerContext* call,
      v1::UploadMeshResponse* response) override;

  grpc::ServerUnaryReactor* InspectMesh(
      grpc::CallbackServerContext* call, const v1::InspectMeshRequest* request,
      v1::InspectMeshResponse* response) override;

 private:
  ServiceContext& context_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_MESH_STORE_SERVICE_H_
