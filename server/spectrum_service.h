#ifndef MARROW_SERVER_SPECTRUM_SERVICE_H_
#define MARROW_SERVER_SPECTRUM_SERVICE_H_

#include <grpcpp/grpcpp.h>

#include "marrow/v1/spectrum_service.grpc.pb.h"
#include "server/service_context.h"

namespace marrow {

// Thread safe.
class SpectrumService final : public v1::SpectrumService::CallbackService {
 public:
  explicit SpectrumService(ServiceContext& context) : context_(context) {}

  grpc::ServerWriteReactor<v1::SpectrumEvent>* ComputeSpectrum(
      grpc::CallbackServerContext* call,
      const v1::ComputeSpectrumRequest* request) override;

 private:
  ServiceContext& context_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_SPECTRUM_SERVICE_H_
