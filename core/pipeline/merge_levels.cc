#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/status_macros.h"
#include "core/boundaries/calibration.h"
#include "core/hierarchy/fine_tree.h"
#include "core/hierarchy/forest.h"
#include "core/hierarchy/merge_tree.h"
#include "core/hierarchy/merged_pieces.h"
#include "core/pipeline/methods.h"

namespace marrow {
namespace {

// What was found on a coarse mesh, on the body's own.
absl::StatusOr<MergeTree> OnOwnMesh(const Job& job, const Body& body,
                                    MergeTree merged) {
  const uint32_t count = body.canonical->mesh.NumFaces();
  if (body.coarse != nullptr) {
    const TriangleMesh& mesh = body.Patched().mesh;
    std::optional<Adjacency> own;
    if (!job.prepared.bodies.IsWhole() || body.patched != nullptr)
      own.emplace(mesh);
    const Adjacency& adjacency = own ? *own : job.prepared.adjacency;
    MARROW_ASSIGN_OR_RETURN(
        merged, ToFine(merged, *body.coarse, mesh, count, adjacency,
                       FaceLinks(adjacency, body.bridges), job.cancel));
  }
  if (body.patched != nullptr) {
    merged.tree = WithoutPatches(merged.tree, body.patched->mesh, count);
    merged.piece_of_face.resize(count);
  }
  return merged;
}

// The tree of every body, in their order.
absl::StatusOr<std::vector<MergeTree>> BodyTrees(const Job& job) {
  const SegmentationOptions& options = job.options;
  std::vector<MergeTree> trees;
  double before = 0;
  for (size_t b = 0; b < job.bodies.size(); ++b) {
    const auto& body = job.bodies[b];
    absl::Status reported;
    const auto pull = [&](double area_share, const ProgressCallback& progress) {
      return body->Pull(area_share, options.split.delta, job.cancel, progress);
    };
    const auto report = [&](double share) {
      const double done = before + body->share() * share;
      reported.Update(job.reporter.Progress(
          Stage::kSegments, kSpectrumDone + (1 - kSpectrumDone) * done));
    };
    MARROW_ASSIGN_OR_RETURN(
        MergeTree merged,
        BuildMergeTree(body->context(), options.split, body->area(),
                       options.levels, job.cancel, pull, report));
    MARROW_RETURN_IF_ERROR(reported);
    MARROW_ASSIGN_OR_RETURN(
        merged,
        OnOwnMesh(job, job.prepared.bodies.bodies[b], std::move(merged)));
    trees.push_back(std::move(merged));
    before += body->share();
  }
  return trees;
}

SegmentTree OneTree(const Prepared& prepared, std::vector<MergeTree>& trees) {
  if (prepared.bodies.IsComputedWhole()) return std::move(trees[0].tree);
  std::vector<const SegmentTree*> pointers;
  pointers.reserve(trees.size());
  for (const MergeTree& tree : trees) pointers.push_back(&tree.tree);
  return PlantForest(prepared.canonical, prepared.areas, prepared.bodies,
                     pointers, BodyRoots::kNone);
}

}  // namespace

absl::Status MergeLevels(const Job& job) {
  MARROW_RETURN_IF_ERROR(PullPairs(job));
  MARROW_ASSIGN_OR_RETURN(std::vector<MergeTree> trees, BodyTrees(job));
  MergedPieces pieces = JoinPieces(job.prepared.bodies, trees);
  const size_t count =
      std::min<size_t>(job.options.levels, std::size(kLevelSalience));
  const auto whole = std::make_shared<const SegmentedMesh>(
      job.workspace, job.options.split, OneTree(job.prepared, trees),
      std::move(pieces),
      std::vector<double>(kLevelSalience, kLevelSalience + count));
  const SegmentTree& tree = whole->tree();
  for (uint32_t level = 1; level <= job.options.levels; ++level) {
    if (level > 1 && level > tree.nodes.back().level) break;
    MARROW_RETURN_IF_ERROR(EmitLevel(job.telling(), tree, level));
  }
  return EmitTree(job.telling(), whole);
}

}  // namespace marrow
