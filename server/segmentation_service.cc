#include "server/segmentation_service.h"

#include <string>
#include <utility>

#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "server/cut_job.h"
#include "server/event_builder.h"
#include "server/event_stream.h"
#include "server/request_parser.h"
#include "server/segment_job.h"
#include "server/status.h"
#include "server/stream_job.h"

namespace marrow {
namespace {

using Plan = JobPlan<v1::SegmentEvent>;

void Accept(const MeshDigest& digest, bool is_kept, SegmentJob& job) {
  v1::SegmentEvent event;
  v1::Accepted* accepted = event.mutable_accepted();
  accepted->set_job_id(job.id());
  SetMeshDigest(digest, accepted->mutable_mesh_digest());
  accepted->set_result(is_kept ? v1::CACHE_OUTCOME_HIT
                               : v1::CACHE_OUTCOME_MISS);
  job.Append(std::move(event));
}

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
  const auto kept = context.results.Find(
      ResultCache::KeyOf(payload.digest, parameters.options));
  plan.open = [digest = payload.digest, is_kept = kept != nullptr](
                  SegmentJob& job) { Accept(digest, is_kept, job); };
  plan.run = [&context, payload, parameters, kept](SegmentJob& job) {
    RunSegmentJob(context, payload, parameters, kept, job);
  };
  plan.quick = kept != nullptr;
  return plan;
}

absl::StatusOr<Plan> MakeCutPlan(ServiceContext& context,
                                 const v1::CutRequest& request,
                                 StreamState<v1::SegmentEvent>& stream) {
  if (context.draining) return Draining();
  if (!request.has_mesh_digest()) {
    return InvalidField("mesh_digest", "is missing; give the digest of a mesh");
  }
  MARROW_ASSIGN_OR_RETURN(
      const MeshDigest digest,
      ParseMeshDigest(request.mesh_digest(), "mesh_digest", context.options));
  MARROW_ASSIGN_OR_RETURN(const SegmentParameters parameters,
                          ParseCutParameters(request));
  stream.Describe("mesh", digest.sha256.Hex().substr(0, 12));
  // Whether the store knows this mesh by another size.
  MARROW_RETURN_IF_ERROR(context.store.Find(digest).status());
  const auto kept =
      context.results.Find(ResultCache::KeyOf(digest, parameters.options));
  if (kept == nullptr) return NotCached(digest.sha256);
  Plan plan;
  plan.key = CutJobKey(digest, parameters);
  plan.open = [digest](SegmentJob& job) { Accept(digest, true, job); };
  plan.run = [digest, parameters, kept](SegmentJob& job) {
    RunCutJob(digest, parameters, kept, job);
  };
  plan.quick = true;
  return plan;
}

// Begins the call's stream by what `make_plan` gives for it.
template <typename MakePlan>
grpc::ServerWriteReactor<v1::SegmentEvent>* Answer(
    ServiceContext& context, grpc::CallbackServerContext& call,
    const char* method, const MakePlan& make_plan) {
  auto* reactor = new EventStream<v1::SegmentEvent>(context, call, method);
  const auto stream = reactor->state();
  absl::StatusOr<Plan> plan = make_plan(*stream);
  if (plan.ok()) {
    AnswerFromJob(context, context.segment_jobs, *stream, *std::move(plan));
  } else {
    stream->Begin(plan.status(), false, nullptr);
  }
  return reactor;
}

}  // namespace

grpc::ServerWriteReactor<v1::SegmentEvent>* SegmentationService::Segment(
    grpc::CallbackServerContext* call, const v1::SegmentRequest* request) {
  return Answer(context_, *call, "SegmentationService.Segment",
                [&](StreamState<v1::SegmentEvent>& stream) {
                  return MakePlan(context_, *request, stream);
                });
}

grpc::ServerWriteReactor<v1::SegmentEvent>* SegmentationService::Cut(
    grpc::CallbackServerContext* call, const v1::CutRequest* request) {
  return Answer(context_, *call, "SegmentationService.Cut",
                [&](StreamState<v1::SegmentEvent>& stream) {
                  return MakeCutPlan(context_, *request, stream);
                });
}

}  // namespace marrow
