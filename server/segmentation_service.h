#ifndef MARROW_SERVER_SEGMENTATION_SERVICE_H_
#define MARROW_SERVER_SEGMENTATION_SERVICE_H_

#include <grpcpp/grpcpp.h>

#include "marrow/v1/segmentation_service.grpc.pb.h"
#include "server/service_context.h"

namespace marrow {

// The gRPC shell of segment_job and cut_job. Thread safe.
class SegmentationService final
    : public v1::SegmentationService::CallbackService {
 public:
  explicit SegmentationService(ServiceContext& context) : context_(context) {}

  grpc::ServerWriteReactor<v1::SegmentEvent>* Segment(
      grpc::CallbackServerContext* call,
      const v1::SegmentRequest* request) override;
  grpc::ServerWriteReactor<v1::SegmentEvent>* Cut(
      grpc::CallbackServerContext* call,
      const v1::CutRequest* request) override;

 private:
  ServiceContext& context_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_SEGMENTATION_SERVICE_H_
