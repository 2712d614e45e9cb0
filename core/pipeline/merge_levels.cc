#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/status_macros.h"
#include "core/hierarchy/forest.h"
#include "core/hierarchy/merge_tree.h"
#include "core/pipeline/methods.h"

namespace marrow {
namespace {

// The tree of every body, in their order.
absl::StatusOr<std::vector<SegmentTree>> BodyTrees(const Job& job) {
  std::vector<SegmentTree> trees;
  double before = 0;
  for (const auto& body : job.bodies) {
    absl::Status reported;
    MARROW_ASSIGN_OR_RETURN(
        MergeTree merged,
        BuildMergeTree(body->context(), job.options.split, body->area(),
                       job.options.levels, job.cancel, [&](double share) {
                         const double done = before + body->share() * share;
                         reported.Update(job.reporter.Progress(
                             Stage::kSegments,
                             kSpectrumDone + (1 - kSpectrumDone) * done));
                       }));
    MARROW_RETURN_IF_ERROR(reported);
    trees.push_back(std::move(merged.tree));
    before += body->share();
  }
  return trees;
}

SegmentTree OneTree(const Prepared& prepared, std::vector<SegmentTree> trees) {
  if (prepared.bodies.IsWhole()) return std::move(trees[0]);
  std::vector<const SegmentTree*> pointers;
  for (const SegmentTree& tree : trees) pointers.push_back(&tree);
  return PlantForest(prepared.canonical, prepared.areas, prepared.bodies,
                     pointers, BodyRoots::kNone);
}

}  // namespace

absl::Status MergeLevels(const Job& job) {
  MARROW_RETURN_IF_ERROR(PullPairs(job, 0));
  MARROW_ASSIGN_OR_RETURN(std::vector<SegmentTree> trees, BodyTrees(job));
  const SegmentTree tree = OneTree(job.prepared, std::move(trees));
  for (uint32_t level = 1; level <= job.options.levels; ++level) {
    if (level > 1 && level > tree.nodes.back().level) break;
    MARROW_RETURN_IF_ERROR(EmitLevel(job, tree, level));
  }
  return EmitTree(job, tree);
}

}  // namespace marrow
