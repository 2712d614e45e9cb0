#include "core/pipeline/pipeline.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/status_macros.h"
#include "core/operators/bodies.h"
#include "core/pipeline/job.h"
#include "core/pipeline/methods.h"

namespace marrow {

absl::StatusOr<CanonicalMesh> LoadMesh(std::string_view draco_bytes,
                                       const MeshLimits& limits,
                                       const CancelToken& cancel) {
  MARROW_ASSIGN_OR_RETURN(const DecodedMesh decoded,
                          DecodeDraco(draco_bytes, limits, cancel));
  return Canonicalize(decoded, cancel);
}

std::vector<uint32_t> PointOfVertex(const CanonicalMesh& mesh) {
  std::vector<uint32_t> point(mesh.mesh.NumVertices(), kNoIndex);
  for (uint32_t p = 0; p < mesh.point_map.size(); ++p) {
    const uint32_t v = mesh.point_map[p];
    if (v != kNoIndex && point[v] == kNoIndex) point[v] = p;
  }
  return point;
}

absl::Status Run(std::string_view draco_bytes, const MeshLimits& limits,
                 const SegmentationOptions& options, EigenPairSource& pairs,
                 const CancelToken& cancel, Sink& sink) {
  MARROW_RETURN_IF_ERROR(ValidateOptions(options));
  Reporter reporter(sink, cancel);
  MARROW_RETURN_IF_ERROR(reporter.Progress(Stage::kMesh, 0));
  const auto workspace = std::make_shared<Workspace>();
  CanonicalMesh& canonical = workspace->canonical;
  MARROW_ASSIGN_OR_RETURN(canonical, LoadMesh(draco_bytes, limits, cancel));
  const Bodies& bodies = workspace->bodies = FindBodies(canonical, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  MARROW_RETURN_IF_ERROR(reporter.Took(sink.OnMesh(canonical)));
  MARROW_RETURN_IF_ERROR(reporter.Progress(Stage::kSpectrum, kMeshDone));
  const Prepared& prepared =
      workspace->prepared.emplace(Prepare(canonical, bodies, cancel));
  MARROW_RETURN_IF_ERROR(cancel.Check());
  for (const Body& body : bodies.bodies) {
    const uint32_t most = PairsOfBody(body, options.eigen_pairs);
    MARROW_ASSIGN_OR_RETURN(
        std::unique_ptr<PreparedBody> ready,
        PreparedBody::Make(prepared, body, most,
                           pairs.Open(body.Computed(), most), cancel));
    workspace->prepared_bodies.push_back(std::move(ready));
  }
  const Job job{workspace, prepared, workspace->prepared_bodies,
                options,   cancel,   reporter,
                sink};
  return options.method == Method::kMerge ? MergeLevels(job) : SplitLevels(job);
}

absl::Status Replay(const std::shared_ptr<const SegmentedMesh>& mesh,
                    const CancelToken& cancel, Sink& sink) {
  Reporter reporter(sink, cancel);
  MARROW_RETURN_IF_ERROR(reporter.Took(sink.OnMesh(mesh->canonical())));
  const SegmentTree& tree = mesh->tree();
  const uint32_t levels = std::max(1u, tree.nodes.back().level);
  for (uint32_t level = 1; level <= levels; ++level)
    MARROW_RETURN_IF_ERROR(
        EmitLevel({mesh->prepared(), reporter, sink}, tree, level));
  return EmitTree({mesh->prepared(), reporter, sink}, mesh);
}

}  // namespace marrow
