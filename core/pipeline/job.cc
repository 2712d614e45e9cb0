#include "core/pipeline/job.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/memory/memory.h"
#include "core/base/status_macros.h"
#include "core/diffusion/diffusion_map.h"
#include "core/operators/laplacian.h"
#include "core/pipeline/labels.h"
#include "core/skeleton/skeleton.h"

namespace marrow {
absl::Status Reporter::Took(bool go_on) {
  if (!go_on) return absl::CancelledError("nobody listens any more");
  return cancel_.Check();
}

absl::Status Reporter::Progress(Stage stage, double fraction) {
  fraction_ = std::max(fraction_, fraction);
  return Took(sink_.OnProgress(stage, fraction_));
}

Prepared Prepare(const CanonicalMesh& canonical, const Bodies& bodies,
                 const CancelToken& cancel) {
  Prepared prepared{canonical,
                    bodies,
                    Adjacency(canonical.mesh, cancel),
                    FaceAreaShares(canonical.mesh),
                    {}};
  for (const Body& body : bodies.bodies) {
    for (const auto& [u, v] : body.bridges)
      if (body.vertices[u] != body.vertices[v])
        prepared.bridges.push_back({body.vertices[u], body.vertices[v]});
    prepared.bridges.insert(prepared.bridges.end(), body.seams.begin(),
                            body.seams.end());
  }
  return prepared;
}

struct PreparedBody::Own {
  Own(const TriangleMesh& mesh, const CancelToken& cancel)
      : adjacency(mesh, cancel), areas(FaceAreaShares(mesh)) {}
  const Adjacency adjacency;
  const std::vector<double> areas;
};

absl::StatusOr<std::unique_ptr<PreparedBody>> PreparedBody::Make(
    const Prepared& prepared, const Body& body, uint32_t most_pairs,
    std::unique_ptr<EigenPairStream> stream, const CancelToken& cancel) {
  const TriangleMesh& mesh = body.Computed().mesh;
  std::shared_ptr<const Own> own;
  if (!prepared.bodies.IsComputedWhole())
    own = std::make_shared<const Own>(mesh, cancel);
  const std::vector<Bridge> bridges =
      body.coarse == nullptr ? body.bridges : FindBridges(mesh, cancel);
  // Before anything walks what may be half built.
  MARROW_RETURN_IF_ERROR(cancel.Check());
  return absl::WrapUnique(new PreparedBody(
      prepared, body, std::move(own), bridges, most_pairs, std::move(stream)));
}

PreparedBody::PreparedBody(const Prepared& prepared, const Body& body,
                           std::shared_ptr<const Own> own,
                           const std::vector<Bridge>& bridges,
                           uint32_t most_pairs,
                           std::unique_ptr<EigenPairStream> stream)
    : area_(body.Computed().report.area),
      share_(body.share),
      most_pairs_(std::min(most_pairs, body.Computed().mesh.NumVertices() - 1)),
      own_(std::move(own)),
      slowest_(body.Computed().mesh, own_ ? own_->areas : prepared.areas,
               bridges),
      stream_(std::move(stream)),
      pulled_{std::make_shared<const EigenPairs>(), 0},
      context_{body.Computed().mesh,
               own_ ? own_->adjacency : prepared.adjacency,
               pulled_,
               own_ ? own_->areas : prepared.areas,
               FaceLinks(own_ ? own_->adjacency : prepared.adjacency, bridges),
               body.share / prepared.bodies.bodies[0].share,
               PatchesOf(body)} {}

absl::Status PreparedBody::Pull(double area_share, double delta,
                                const CancelToken& cancel,
                                const ProgressCallback& progress) {
  MARROW_RETURN_IF_ERROR(FindSlowest(cancel, progress));
  const auto& pairs = pulled_.pairs;
  std::optional<uint32_t> taken;
  for (double bound = 0;;) {
    if (pairs->NumPairs() > 1) {
      // A little less, for the sum of a region's areas may be rounded.
      const double t = TimeScale(pulled_.slowest, (1 - 1e-9) * area_share);
      taken = MapDimension(*pairs, t, delta);
      bound = std::max(-std::log(delta) / t,
                       pairs->eigenvalues[pairs->NumPairs() - 1]);
    }
    if (taken || stream_ == nullptr) break;
    MARROW_RETURN_IF_ERROR(PullUpTo(bound, cancel, progress));
  }
  pulled_.usable = std::max(pulled_.usable,
                            taken ? *taken : NumPairsOfWholeClusters(*pairs));
  return absl::OkStatus();
}

absl::Status PreparedBody::FindSlowest(const CancelToken& cancel,
                                       const ProgressCallback& progress) {
  if (pulled_.slowest > 0) return absl::OkStatus();
  const auto& pairs = pulled_.pairs;
  while (!slowest_.IsKnownFrom(*pairs) && stream_ != nullptr) {
    const double bound =
        pairs->NumPairs() > 1 ? pairs->eigenvalues[pairs->NumPairs() - 1] : 0;
    MARROW_RETURN_IF_ERROR(PullUpTo(bound, cancel, progress));
  }
  if (pairs->NumPairs() > 1) pulled_.slowest = slowest_.Of(*pairs);
  return absl::OkStatus();
}

absl::Status PreparedBody::PullUpTo(double bound, const CancelToken& cancel,
                                    const ProgressCallback& progress) {
  MARROW_ASSIGN_OR_RETURN(std::shared_ptr<const EigenPairs> longer,
                          stream_->UpTo(bound, cancel, progress));
  if (longer->NumPairs() == pulled_.pairs->NumPairs()) stream_.reset();
  pulled_.pairs = std::move(longer);
  return absl::OkStatus();
}

absl::Status PullPairs(const Job& job) {
  double before = 0;
  for (const auto& body : job.bodies) {
    // The solver looks at the token alone, so a sink that has had enough is
    // heard when the solver is done, unless its owner cancels too.
    MARROW_RETURN_IF_ERROR(
        body->Pull(1, job.options.split.delta, job.cancel, [&](double share) {
          const double done = before + body->share() * share;
          (void)job.reporter.Progress(
              Stage::kSpectrum, kMeshDone + (kSpectrumDone - kMeshDone) * done);
        }));
    before += body->share();
  }
  return absl::OkStatus();
}

absl::Status EmitLevel(const Telling& to, const SegmentTree& tree,
                       uint32_t level) {
  const Prepared& prepared = to.prepared;
  const std::vector<uint32_t> face_segment = tree.FaceSegments(level);
  const std::vector<uint32_t> face_labels =
      LabelFaces(prepared.canonical, face_segment);
  const std::vector<uint32_t> point_labels = LabelPoints(
      prepared.canonical, prepared.adjacency, prepared.areas, face_segment);
  const Skeleton skeleton =
      BuildSkeleton(prepared.canonical.mesh, prepared.adjacency, tree, level,
                    prepared.bridges);
  return to.reporter.Took(
      to.sink.OnLevel({level, tree, face_labels, point_labels, skeleton}));
}

absl::Status EmitTree(const Telling& to,
                      std::shared_ptr<const SegmentedMesh> whole) {
  MARROW_RETURN_IF_ERROR(to.reporter.Progress(Stage::kSegments, 1));
  MARROW_RETURN_IF_ERROR(to.reporter.Took(to.sink.OnTree(whole->tree())));
  return to.reporter.Took(to.sink.OnSegmentedMesh(std::move(whole)));
}

}  // namespace marrow
