#ifndef MARROW_SERVER_CAPABILITIES_SERVICE_H_
#define MARROW_SERVER_CAPABILITIES_SERVICE_H_

#include <grpcpp/grpcpp.h>

#include "marrow/v1/capabilities_service.grpc.pb.h"
#include "server/service_context.h"

namespace marrow {

// Thread safe.
class CapabilitiesService final
    : public v1::CapabilitiesService::CallbackService {
 public:
  explicit CapabilitiesService(ServiceContext& context) : context_(context) {}

  grpc::ServerUnaryReactor* GetCapabilities(
      grpc::CallbackServerContext* call,
      const v1::GetCapabilitiesRequest* request,
      v1::GetCapabilitiesResponse* response) override;

 private:
  ServiceContext& context_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_CAPABILITIES_SERVICE_H_
