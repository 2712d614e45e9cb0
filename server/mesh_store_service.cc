#include "server/mesh_store_service.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/operators/bodies.h"
#include "core/operators/laplacian.h"
#include "server/compute_pool.h"
#include "server/event_builder.h"
#include "server/request_parser.h"
#include "server/run_guarded.h"
#include "server/status.h"
#include "server/unary_call.h"
#include "server/upload_call.h"

namespace marrow {
namespace {

constexpr int kMaxDigestsAsked = 1000;

absl::StatusOr<v1::FindMissingMeshesResponse> FindMissing(
    ServiceContext& context, const v1::FindMissingMeshesRequest& request) {
  if (context.draining) return Draining();
  if (request.digests_size() > kMaxDigestsAsked) {
    return InvalidField(
        "digests",
        absl::StrCat("has ", request.digests_size(), " entries; at most ",
                     kMaxDigestsAsked, " can be asked for at once"));
  }
  v1::FindMissingMeshesResponse response;
  for (int i = 0; i < request.digests_size(); ++i) {
    MARROW_ASSIGN_OR_RETURN(
        const MeshDigest digest,
        ParseMeshDigest(request.digests(i), absl::StrCat("digests[", i, "]"),
                        context.options));
    MARROW_ASSIGN_OR_RETURN(const auto payload, context.store.Find(digest));
    if (payload == nullptr) *response.add_missing() = request.digests(i);
  }
  return response;
}

struct Inspection {
  Payload payload;
  uint32_t eigen_pairs;
};

absl::StatusOr<Inspection> ParseInspection(
    ServiceContext& context, const v1::InspectMeshRequest& request) {
  if (context.draining) return Draining();
  Inspection inspection;
  MARROW_ASSIGN_OR_RETURN(
      inspection.eigen_pairs,
      ParseEigenPairs(request.has_eigen_pairs(), request.eigen_pairs(),
                      "eigen_pairs"));
  MARROW_ASSIGN_OR_RETURN(inspection.payload,
                          ResolveMesh(request.has_mesh(), request.mesh(),
                                      context.options, context.store));
  return inspection;
}

// Whether a Segment call with so many pairs would need no solver. Which of them
// it takes is known once it has run: then by its result, else where all are
// there.
bool IsCached(ServiceContext& context, const MeshDigest& digest,
              const Bodies& bodies, uint32_t count) {
  SegmentationOptions options;
  options.eigen_pairs = count;
  if (context.results.Find(ResultCache::KeyOf(digest, options)) != nullptr) {
    return true;
  }
  return std::all_of(bodies.bodies.begin(), bodies.bodies.end(),
                     [&](const Body& body) {
                       return context.spectra.Contains(
                           body.Computed(), PairsOfBody(body, count));
                     });
}

// What it takes to make operators of the bodies' triangles. Those that cannot
// be one are left out: Segment says why.
LaplacianReport OperatorReportOn(const Bodies& bodies,
                                 const CancelToken& cancel) {
  LaplacianReport sum;
  for (const Body& body : bodies.bodies) {
    const absl::StatusOr<Laplacian> laplacian =
        BuildLaplacian(body.Computed().mesh, cancel);
    if (laplacian.ok()) sum.Add(laplacian->report);
  }
  return sum;
}

absl::StatusOr<v1::InspectMeshResponse> Inspect(ServiceContext& context,
                                                const Inspection& inspection,
                                                const CancelToken& cancel) {
  MARROW_ASSIGN_OR_RETURN(
      CanonicalMesh mesh,
      context.engine.load_mesh(*inspection.payload.bytes,
                               context.options.mesh_limits, cancel));
  const uint32_t count = inspection.eigen_pairs;
  v1::InspectMeshResponse response;
  const Bodies bodies = FindBodies(mesh, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  response.set_spectrum_cached(
      IsCached(context, inspection.payload.digest, bodies, count));
  const LaplacianReport repairs = OperatorReportOn(bodies, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  response.set_edge_flips(static_cast<uint32_t>(repairs.flips));
  response.set_mollification(repairs.mollification);
  SetMeshReport(mesh.report, response.mutable_report());
  SetPrediction(mesh.report, count, response.mutable_report());
  SetMeshDigest(inspection.payload.digest, response.mutable_mesh_digest());
  SetGeometryDigest(mesh.geometry_digest, response.mutable_geometry_digest());
  response.set_predicted_seconds(response.report().predicted_seconds());
  response.set_predicted_bytes(response.report().predicted_bytes());
  return response;
}

}  // namespace

grpc::ServerUnaryReactor* MeshStoreService::FindMissingMeshes(
    grpc::CallbackServerContext* call,
    const v1::FindMissingMeshesRequest* request,
    v1::FindMissingMeshesResponse* response) {
  auto* reactor = new UnaryCall<v1::FindMissingMeshesResponse>(
      context_, *call, "MeshStoreService.FindMissingMeshes", response);
  reactor->state()->Finish(FindMissing(context_, *request));
  return reactor;
}

grpc::ServerReadReactor<v1::UploadMeshRequest>* MeshStoreService::UploadMesh(
    grpc::CallbackServerContext* call, v1::UploadMeshResponse* response) {
  auto* reactor = new UploadCall(context_, *call, response);
  reactor->Begin();
  return reactor;
}

grpc::ServerUnaryReactor* MeshStoreService::InspectMesh(
    grpc::CallbackServerContext* call, const v1::InspectMeshRequest* request,
    v1::InspectMeshResponse* response) {
  auto* reactor = new UnaryCall<v1::InspectMeshResponse>(
      context_, *call, "MeshStoreService.InspectMesh", response);
  const auto state = reactor->state();
  absl::StatusOr<Inspection> inspection = ParseInspection(context_, *request);
  if (!inspection.ok()) {
    state->Finish(inspection.status());
    return reactor;
  }
  state->Describe("mesh",
                  inspection->payload.digest.sha256.Hex().substr(0, 12));
  const absl::Status accepted = context_.pool.Submit(
      state->cancel(),
      [&context = context_, state, inspection = *std::move(inspection)] {
        v1::InspectMeshResponse found;
        const absl::Status status = RunGuarded(*state->cancel(), [&] {
          auto result = Inspect(context, inspection, *state->cancel());
          if (!result.ok()) return result.status();
          found = *std::move(result);
          return absl::OkStatus();
        });
        ComputePool::CountAsIdle();
        if (status.ok()) {
          state->Finish(std::move(found));
        } else {
          state->Finish(status);
        }
      });
  if (!accepted.ok()) state->Finish(accepted);
  return reactor;
}

}  // namespace marrow
