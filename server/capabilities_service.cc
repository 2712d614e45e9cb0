#include "server/capabilities_service.h"

#include <algorithm>

#include "core/boundaries/calibration.h"
#include "server/unary_call.h"

namespace marrow {
namespace {

void SetLimits(const ServerOptions& options, v1::MeshLimits* limits) {
  limits->set_max_inline_mesh_bytes(
      std::min(options.max_inline_mesh_bytes, options.mesh_limits.max_bytes));
  limits->set_max_mesh_bytes(options.mesh_limits.max_bytes);
  limits->set_max_faces(options.mesh_limits.max_faces);
  limits->set_max_vertices(options.mesh_limits.max_vertices);
}

void SetDefaults(v1::SegmentationOptions* message) {
  const SegmentationOptions defaults;
  message->set_method(defaults.method == Method::kMerge ? v1::METHOD_MERGE
                                                        : v1::METHOD_PAPER);
  message->set_kappa(defaults.split.kappa);
  message->set_delta(defaults.split.delta);
  message->set_epsilon(defaults.split.epsilon);
  message->set_tolerance(defaults.split.tolerance);
  message->set_eigen_pairs(defaults.eigen_pairs);
  message->set_levels(defaults.levels);
}

v1::GetCapabilitiesResponse Describe(const ServerOptions& options) {
  v1::GetCapabilitiesResponse response;
  response.set_version(kVersion);
  response.set_algorithm_revision(kAlgorithmRevision);
  SetLimits(options, response.mutable_mesh_limits());
  SetDefaults(response.mutable_default_options());
  for (const ParameterRange& range : ParameterRanges()) {
    v1::ParameterRange* message = response.add_parameter_ranges();
    message->set_field(range.field);
    message->set_min(range.min);
    message->set_max(range.max);
  }
  response.add_methods(v1::METHOD_PAPER);
  response.add_methods(v1::METHOD_MERGE);
  for (const char* bitstream : {"2.0", "2.1", "2.2"}) {
    response.add_draco_bitstreams(bitstream);
  }
  response.set_automatic_salience(kAutomaticSalience);
  response.set_result_cache_bytes(options.result_cache_bytes);
  return response;
}

}  // namespace

grpc::ServerUnaryReactor* CapabilitiesService::GetCapabilities(
    grpc::CallbackServerContext* call, const v1::GetCapabilitiesRequest*,
    v1::GetCapabilitiesResponse* response) {
  auto* reactor = new UnaryCall<v1::GetCapabilitiesResponse>(
      context_, *call, "CapabilitiesService.GetCapabilities", response);
  reactor->state()->Finish(Describe(context_.options));
  return reactor;
}

}  // namespace marrow
