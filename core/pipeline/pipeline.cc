#include "core/pipeline/pipeline.h"

#include <memory>
#include <utility>

#include "core/base/status_macros.h"
#include "core/operators/bodies.h"
#include "core/pipeline/job.h"
#include "core/pipeline/methods.h"

namespace marrow {
namespace {

// DecodeDraco, then Canonicalize.
absl::StatusOr<CanonicalMesh> LoadCanonical(std::string_view draco_bytes,
                                            const MeshLimits& limits) {
  MARROW_ASSIGN_OR_RETURN(const DecodedMesh decoded,
                          DecodeDraco(draco_bytes, limits));
  return Canonicalize(decoded);
}

}  // namespace

absl::StatusOr<CanonicalMesh> LoadMesh(std::string_view draco_bytes,
                                       const MeshLimits& limits) {
  MARROW_ASSIGN_OR_RETURN(CanonicalMesh canonical,
                          LoadCanonical(draco_bytes, limits));
  (void)FindBodies(canonical);
  return canonical;
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
  MARROW_ASSIGN_OR_RETURN(CanonicalMesh canonical,
                          LoadCanonical(draco_bytes, limits));
  const Bodies bodies = FindBodies(canonical);
  MARROW_RETURN_IF_ERROR(reporter.Took(sink.OnMesh(canonical)));
  MARROW_RETURN_IF_ERROR(reporter.Progress(Stage::kSpectrum, kMeshDone));
  const Prepared prepared = Prepare(canonical, bodies);
  std::vector<std::unique_ptr<PreparedBody>> prepared_bodies;
  for (const Body& body : bodies.bodies)
    prepared_bodies.push_back(std::make_unique<PreparedBody>(
        prepared, body,
        pairs.Open(*body.canonical, PairsOfBody(body, options.eigen_pairs))));
  const Job job{prepared, prepared_bodies, options, cancel, reporter, sink};
  return options.method == Method::kMerge ? MergeLevels(job) : SplitLevels(job);
}

}  // namespace marrow
