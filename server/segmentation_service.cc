#include "server/segmentation_service.h"

#include <string>
#include <utility>

#include "core/base/status_macros.h"
#include "server/event_builder.h"
#include "server/event_stream.h"
#include "server/request_parser.h"
#include "server/segment_job.h"
#include "server/status.h"
#include "server/stream_job.h"

namespace marrow {
namespace {

using Plan = JobPlan<v1::SegmentEvent>;

absl::StatusOr<Plan> MakePlan(ServiceContext& context,
                              const v1::SegmentRequest& request,
                              StreamState<v1::SegmentEvent>& stream) {
  if (context.draining) return Draining();
  MARROW_ASSIGN_OR_RETURN(const SegmentParameters parameters,
                          ParseSegmentParameters(request));
  MARROW_ASSIGN_OR_RETURN(const Payload payload,
                          ResolveMesh(request.has_mesh(), request.mesh(),
                                      context.options, context.store));
  stream.Describe("mesh", payload.digest.sha256.Hex().substr(0, 12));
  Plan plan;
  plan.key = SegmentJobKey(payload.digest, parameters);
  plan.open = [digest = payload.digest](SegmentJob& job) {
    v1::SegmentEvent event;
    event.mutable_accepted()->set_job_id(job.id());
    SetMeshDigest(digest, event.mutable_accepted()->mutable_mesh_digest());
    job.Append(std::move(event));
  };
  plan.run = [&context, payload, parameters](SegmentJob& job) {
    RunSegmentJob(context, payload, parameters, job);
  };
  return plan;
}

}  // namespace

grpc::ServerWriteReactor<v1::SegmentEvent>* SegmentationService::Segment(
    grpc::CallbackServerContext* call, const v1::SegmentRequest* request) {
  auto* reactor = new EventStream<v1::SegmentEvent>(
      context_, *call, "SegmentationService.Segment");
  const auto stream = reactor->state();
  absl::StatusOr<Plan> plan = MakePlan(context_, *request, *stream);
  if (plan.ok()) {
    AnswerFromJob(context_, context_.segment_jobs, *stream, *std::move(plan));
  } else {
    stream->Begin(plan.status(), false, nullptr);
  }
  return reactor;
}

}  // namespace marrow
