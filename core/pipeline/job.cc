#include "core/pipeline/job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/status_macros.h"
#include "core/diffusion/diffusion_map.h"
#include "core/operators/laplacian.h"
#include "core/skeleton/skeleton.h"

namespace marrow {
namespace {

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

}  // namespace

absl::Status Reporter::Took(bool go_on) {
  if (!go_on) return absl::CancelledError("nobody listens any more");
  return cancel_.Check();
}

absl::Status Reporter::Progress(Stage stage, double fraction) {
  fraction_ = std::max(fraction_, fraction);
  return Took(sink_.OnProgress(stage, fraction_));
}

Prepared Prepare(const CanonicalMesh& canonical, const Bodies& bodies) {
  Prepared prepared{canonical,
                    bodies,
                    Adjacency(canonical.mesh),
                    FaceAreaShares(canonical.mesh),
                    {}};
  for (const Body& body : bodies.bodies)
    for (const auto& [u, v] : body.bridges)
      prepared.bridges.push_back({body.vertices[u], body.vertices[v]});
  return prepared;
}

struct PreparedBody::Own {
  explicit Own(const TriangleMesh& mesh)
      : adjacency(mesh), areas(FaceAreaShares(mesh)) {}
  const Adjacency adjacency;
  const std::vector<double> areas;
};

PreparedBody::PreparedBody(const Prepared& prepared, const Body& body,
                           std::unique_ptr<EigenPairStream> stream)
    : area_(body.canonical->report.area),
      share_(body.share),
      own_(prepared.bodies.IsWhole()
               ? nullptr
               : std::make_shared<const Own>(body.canonical->mesh)),
      stream_(std::move(stream)),
      context_{body.canonical->mesh,
               own_ ? own_->adjacency : prepared.adjacency, pairs_,
               own_ ? own_->areas : prepared.areas,
               FaceLinks(own_ ? own_->adjacency : prepared.adjacency,
                         body.bridges)} {}

absl::Status PreparedBody::Pull(double area_share, double delta,
                                const CancelToken& cancel,
                                const ProgressCallback& progress) {
  const bool all = area_share <= 0;
  double bound = all ? std::numeric_limits<double>::infinity() : 0;
  while (stream_ != nullptr) {
    if (!all && pairs_.NumPairs() > 1) {
      // A little less, for the sum of a region's areas may be rounded.
      const double t = TimeScale(pairs_, (1 - 1e-9) * area_share);
      if (MapDimension(pairs_, t, delta)) return absl::OkStatus();
      bound = std::max(-std::log(delta) / t,
                       pairs_.eigenvalues[pairs_.NumPairs() - 1]);
    }
    MARROW_ASSIGN_OR_RETURN(const std::shared_ptr<const EigenPairs> longer,
                            stream_->UpTo(bound, cancel, progress));
    const bool ended = longer->NumPairs() == pairs_.NumPairs();
    if (ended || std::isinf(bound)) stream_.reset();
    if (!ended) pairs_ = *longer;
  }
  return absl::OkStatus();
}

absl::Status PullPairs(const Job& job, double area_share) {
  double before = 0;
  for (const auto& body : job.bodies) {
    // The solver looks at the token alone, so a sink that has had enough is
    // heard when the solver is done, unless its owner cancels too.
    MARROW_RETURN_IF_ERROR(body->Pull(
        area_share, job.options.split.delta, job.cancel, [&](double share) {
          const double done = before + body->share() * share;
          (void)job.reporter.Progress(
              Stage::kSpectrum, kMeshDone + (kSpectrumDone - kMeshDone) * done);
        }));
    before += body->share();
  }
  return absl::OkStatus();
}

absl::Status EmitLevel(const Job& job, const SegmentTree& tree,
                       uint32_t level) {
  const Prepared& prepared = job.prepared;
  const std::vector<uint32_t> face_segment = tree.FaceSegments(level);
  std::vector<uint32_t> face_labels;
  face_labels.reserve(prepared.canonical.face_map.size());
  for (uint32_t f : prepared.canonical.face_map)
    face_labels.push_back(face_segment[f]);
  const std::vector<uint32_t> point_labels = PointLabels(
      prepared.canonical, prepared.adjacency, prepared.areas, face_segment);
  const Skeleton skeleton =
      BuildSkeleton(prepared.canonical.mesh, prepared.adjacency, tree, level,
                    prepared.bridges);
  return job.reporter.Took(
      job.sink.OnLevel({level, tree, face_labels, point_labels, skeleton}));
}

absl::Status EmitTree(const Job& job, const SegmentTree& tree) {
  MARROW_RETURN_IF_ERROR(job.reporter.Progress(Stage::kSegments, 1));
  return job.reporter.Took(job.sink.OnTree(tree));
}

}  // namespace marrow
