#include "core/pipeline/pipeline.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "core/base/status_macros.h"
#include "core/hierarchy/forest.h"
#include "core/hierarchy/tree_builder.h"
#include "core/mesh/adjacency.h"
#include "core/operators/bodies.h"
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
  const Bodies& bodies;
  Adjacency adjacency;
  std::vector<double> areas;
  std::vector<Bridge> bridges;
};

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
      BuildSkeleton(prepared.canonical.mesh, prepared.adjacency, tree, level,
                    prepared.bridges);
  return reporter.Took(
      sink.OnLevel({level, tree, face_labels, point_labels, skeleton}));
}

// Where the work on a body stands.
class BodyTree {
 public:
  // Of a mesh that is one body, what is prepared is used again.
  BodyTree(const Prepared& prepared, const Body& body,
           std::shared_ptr<const EigenPairs> pairs, const SplitOptions& options)
      : share_(body.share),
        own_(prepared.bodies.IsWhole()
                 ? nullptr
                 : std::make_unique<Own>(body.canonical->mesh)),
        adjacency_(own_ ? own_->adjacency : prepared.adjacency),
        areas_(own_ ? own_->areas : prepared.areas),
        pairs_(std::move(pairs)),
        builder_({body.canonical->mesh, adjacency_, *pairs_, areas_,
                  FaceLinks(adjacency_, body.bridges)},
                 options, body.canonical->report.area) {}
  BodyTree(const BodyTree&) = delete;
  BodyTree& operator=(const BodyTree&) = delete;

  // Whether it became deeper. Not tried again once it did not.
  absl::StatusOr<bool> Deepen(const CancelToken& cancel,
                              const std::function<void(double)>& progress) {
    if (done_) return false;
    MARROW_ASSIGN_OR_RETURN(const bool deeper,
                            builder_.Deepen(cancel, progress));
    done_ = !deeper;
    return deeper;
  }
  void StopAtDepth() { builder_.StopAtDepth(); }

  double share() const { return share_; }
  const SegmentTree& tree() const { return builder_.tree(); }

 private:
  struct Own {
    explicit Own(const TriangleMesh& mesh)
        : adjacency(mesh), areas(FaceAreaShares(mesh)) {}
    const Adjacency adjacency;
    const std::vector<double> areas;
  };

  const double share_;
  const std::unique_ptr<const Own> own_;
  const Adjacency& adjacency_;
  const std::vector<double>& areas_;
  const std::shared_ptr<const EigenPairs> pairs_;
  TreeBuilder builder_;
  bool done_ = false;
};

// The tree of the whole mesh, a level at a time.
class Forest {
 public:
  Forest(const Prepared& prepared,
         const std::vector<std::shared_ptr<const EigenPairs>>& pairs,
         const SplitOptions& options)
      : prepared_(prepared) {
    for (size_t b = 0; b < pairs.size(); ++b)
      bodies_.push_back(std::make_unique<BodyTree>(
          prepared, prepared.bodies.bodies[b], pairs[b], options));
    Plant();
  }

  // As TreeBuilder::Deepen(); the first split of several bodies is into them.
  absl::StatusOr<bool> Deepen(const CancelToken& cancel,
                              const std::function<void(double)>& progress) {
    if (bodies_.size() > 1 && !std::exchange(apart_, true)) return true;
    bool any = false;
    double before = 0;
    for (const auto& body : bodies_) {
      MARROW_ASSIGN_OR_RETURN(
          const bool deeper, body->Deepen(cancel, [&](double share) {
            progress(std::min(1.0, before + body->share() * share));
          }));
      any |= deeper;
      before += body->share();
    }
    Plant();
    return any;
  }

  void StopAtDepth() {
    for (const auto& body : bodies_) body->StopAtDepth();
    Plant();
  }

  const SegmentTree& tree() const {
    return prepared_.bodies.IsWhole() ? bodies_[0]->tree() : tree_;
  }

 private:
  void Plant() {
    if (prepared_.bodies.IsWhole()) return;
    std::vector<const SegmentTree*> trees;
    for (const auto& body : bodies_) trees.push_back(&body->tree());
    tree_ = PlantForest(prepared_.canonical, prepared_.areas, prepared_.bodies,
                        trees);
  }

  const Prepared& prepared_;
  std::vector<std::unique_ptr<BodyTree>> bodies_;
  bool apart_ = false;
  SegmentTree tree_;
};

absl::Status SplitLevels(
    const Prepared& prepared,
    const std::vector<std::shared_ptr<const EigenPairs>>& pairs,
    const SegmentationOptions& options, const CancelToken& cancel,
    Reporter& reporter, Sink& sink) {
  Forest forest(prepared, pairs, options.split);
  for (uint32_t level = 1; level <= options.levels; ++level) {
    absl::Status reported;
    MARROW_ASSIGN_OR_RETURN(
        const bool deeper, forest.Deepen(cancel, [&](double share) {
          reported.Update(reporter.Progress(
              Stage::kSegments, kSpectrumDone + (1 - kSpectrumDone) *
                                                    (level - 1 + share) /
                                                    options.levels));
        }));
    MARROW_RETURN_IF_ERROR(reported);
    if (!deeper && level > 1) break;
    MARROW_RETURN_IF_ERROR(
        EmitLevel(prepared, forest.tree(), level, reporter, sink));
    if (!deeper) break;
  }
  forest.StopAtDepth();
  MARROW_RETURN_IF_ERROR(reporter.Progress(Stage::kSegments, 1));
  return reporter.Took(sink.OnTree(forest.tree()));
}

// The pairs of every body, in their order.
absl::StatusOr<std::vector<std::shared_ptr<const EigenPairs>>> PullPairs(
    const Bodies& bodies, uint32_t count, EigenPairSource& source,
    const CancelToken& cancel, Reporter& reporter) {
  std::vector<std::shared_ptr<const EigenPairs>> pairs;
  double before = 0;
  for (const Body& body : bodies.bodies) {
    // The solver looks at the token alone, so a sink that has had enough is
    // heard when the solver is done, unless its owner cancels too.
    MARROW_ASSIGN_OR_RETURN(
        std::shared_ptr<const EigenPairs> own,
        source.Get(*body.canonical, PairsOfBody(body, count), cancel,
                   [&](double share) {
                     const double done = before + body.share * share;
                     (void)reporter.Progress(
                         Stage::kSpectrum,
                         kMeshDone + (kSpectrumDone - kMeshDone) * done);
                   }));
    pairs.push_back(std::move(own));
    before += body.share;
  }
  return pairs;
}

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
  MARROW_ASSIGN_OR_RETURN(
      const auto eigen_pairs,
      PullPairs(bodies, options.eigen_pairs, pairs, cancel, reporter));
  const Prepared prepared = Prepare(canonical, bodies);
  return SplitLevels(prepared, eigen_pairs, options, cancel, reporter, sink);
}

}  // namespace marrow
