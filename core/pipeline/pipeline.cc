#include "core/pipeline/pipeline.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/status_macros.h"
#include "core/hierarchy/tree_builder.h"
#include "core/mesh/adjacency.h"
#include "core/operators/laplacian.h"

namespace marrow {
namespace {

// Shares of the whole run, by what meshes of 5k to 50k faces take.
constexpr double kMeshDone = 0.05;
constexpr double kSpectrumDone = 0.75;

// Reports to the sink and cancels the run once the sink has had enough.
class Reporter {
 public:
  Reporter(Sink& sink, const CancelToken& cancel)
      : sink_(sink), cancel_(cancel) {}

  absl::Status Took(bool go_on) {
    if (!go_on) return absl::CancelledError("nobody listens any more");
    return cancel_.Check();
  }
  absl::Status Progress(Stage stage, double fraction) {
    fraction_ = std::max(fraction_, fraction);
    return Took(sink_.OnProgress(stage, fraction_));
  }

 private:
  Sink& sink_;
  const CancelToken& cancel_;
  double fraction_ = 0;
};

// Point -> node id by the area around its vertex.
std::vector<uint32_t> PointLabels(const CanonicalMesh& canonical,
                                  const Adjacency& adjacency,
                                  const std::vector<double>& areas,
                                  const std::vector<uint32_t>& face_segment) {
  const uint32_t n = canonical.mesh.NumVertices();
  std::vector<uint32_t> of_vertex(n);
  std::vector<std::pair<uint32_t, double>> around;
  for (uint32_t v = 0; v < n; ++v) {
    around.clear();
    for (uint32_t f : adjacency.VertexFaces(v))
      around.push_back({face_segment[f], areas[f]});
    std::sort(around.begin(), around.end());
    double most = -1;
    for (size_t i = 0; i < around.size();) {
      double sum = 0;
      const uint32_t segment = around[i].first;
      for (; i < around.size() && around[i].first == segment; ++i)
        sum += around[i].second;
      if (sum > most) {
        most = sum;
        of_vertex[v] = segment;
      }
    }
  }
  std::vector<uint32_t> labels(canonical.point_map.size(), kNoIndex);
  for (size_t p = 0; p < labels.size(); ++p)
    if (canonical.point_map[p] != kNoIndex)
      labels[p] = of_vertex[canonical.point_map[p]];
  return labels;
}

// The mesh with what every level needs beside it.
struct Prepared {
  const CanonicalMesh& canonical;
  Adjacency adjacency;
  std::vector<double> areas;
};

absl::Status EmitLevel(const Prepared& prepared, const SegmentTree& tree,
                       uint32_t level, Reporter& reporter, Sink& sink) {
  const std::vector<uint32_t> face_segment = tree.FaceSegments(level);
  std::vector<uint32_t> face_labels;
  face_labels.reserve(prepared.canonical.face_map.size());
  for (uint32_t f : prepared.canonical.face_map)
    face_labels.push_back(face_segment[f]);
  const std::vector<uint32_t> point_labels = PointLabels(
      prepared.canonical, prepared.adjacency, prepared.areas, face_segment);
  const Skeleton skeleton =
      BuildSkeleton(prepared.canonical.mesh, prepared.adjacency, tree, level);
  return reporter.Took(
      sink.OnLevel({level, tree, face_labels, point_labels, skeleton}));
}

absl::Status SplitLevels(const Prepared& prepared, const EigenPairs& pairs,
                         const SegmentationOptions& options,
                         const CancelToken& cancel, Reporter& reporter,
                         Sink& sink) {
  TreeBuilder builder(
      {prepared.canonical.mesh, prepared.adjacency, pairs, prepared.areas},
      options.split, prepared.canonical.report.area);
  for (uint32_t level = 1; level <= options.levels; ++level) {
    absl::Status reported;
    MARROW_ASSIGN_OR_RETURN(
        const bool deeper, builder.Deepen(cancel, [&](double share) {
          reported.Update(reporter.Progress(
              Stage::kSegments, kSpectrumDone + (1 - kSpectrumDone) *
                                                    (level - 1 + share) /
                                                    options.levels));
        }));
    MARROW_RETURN_IF_ERROR(reported);
    if (!deeper && level > 1) break;
    MARROW_RETURN_IF_ERROR(
        EmitLevel(prepared, builder.tree(), level, reporter, sink));
    if (!deeper) break;
  }
  builder.StopAtDepth();
  MARROW_RETURN_IF_ERROR(reporter.Progress(Stage::kSegments, 1));
  return reporter.Took(sink.OnTree(builder.tree()));
}

}  // namespace

absl::StatusOr<CanonicalMesh> LoadMesh(std::string_view draco_bytes,
                                       const MeshLimits& limits) {
  MARROW_ASSIGN_OR_RETURN(const DecodedMesh decoded,
                          DecodeDraco(draco_bytes, limits));
  return Canonicalize(decoded);
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
  MARROW_ASSIGN_OR_RETURN(const CanonicalMesh canonical,
                          LoadMesh(draco_bytes, limits));
  MARROW_RETURN_IF_ERROR(reporter.Took(sink.OnMesh(canonical)));
  MARROW_RETURN_IF_ERROR(reporter.Progress(Stage::kSpectrum, kMeshDone));

  // The solver looks at the token alone, so a sink that has had enough is
  // heard when the solver is done, unless its owner cancels too.
  MARROW_ASSIGN_OR_RETURN(
      const std::shared_ptr<const EigenPairs> eigen_pairs,
      pairs.Get(canonical, options.eigen_pairs, cancel, [&](double share) {
        (void)reporter.Progress(
            Stage::kSpectrum, kMeshDone + (kSpectrumDone - kMeshDone) * share);
      }));
  const Prepared prepared{canonical, Adjacency(canonical.mesh),
                          FaceAreaShares(canonical.mesh)};
  return SplitLevels(prepared, *eigen_pairs, options, cancel, reporter, sink);
}

}  // namespace marrow
