// The paper's recursion, a level at a time.
#ifndef MARROW_CORE_HIERARCHY_TREE_BUILDER_H_
#define MARROW_CORE_HIERARCHY_TREE_BUILDER_H_

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/hierarchy/segment_tree.h"
#include "core/pieces/split_region.h"

namespace marrow {

// Grows a tree from its root by splitting the leaves of the deepest level.
// Not thread safe. What the context refers to must outlive it.
class TreeBuilder {
 public:
  // `mesh_area` is in units of the positions.
  TreeBuilder(const SplitContext& context, const SplitOptions& options,
              double mesh_area);

  // As a share of the mesh, the least area of those that Deepen() with the same
  // `least` will try to split: what pairs they take follows from it. 1 where
  // there are none.
  double LeastShare(double least = 0) const;

  // Tries to split every node of the deepest level that has at least `least` of
  // the mesh's area, two at a time where there are CPUs for it; whether any
  // was. Those that would have fewer than `fewest` parts are left whole. Calls
  // `progress`, on the caller's thread, with the share of their area that has
  // been tried. Errors: CANCELLED; the tree is then not to be used.
  absl::StatusOr<bool> Deepen(const CancelToken& cancel,
                              const std::function<void(double)>& progress,
                              double least = 0, size_t fewest = 2);

  // Marks the leaves of the deepest level as stopped by the depth.
  void StopAtDepth();

  uint32_t depth() const { return depth_; }
  const SegmentTree& tree() const { return tree_; }
  // Nothing else may be called after it.
  SegmentTree TakeTree() { return std::move(tree_); }

 private:
  std::vector<absl::StatusOr<RegionSplit>> SplitAll(
      const std::vector<uint32_t>& leaves, const CancelToken& cancel,
      const std::function<void(double)>& progress) const;
  void AddChildren(uint32_t parent, RegionSplit split);
  std::vector<uint32_t> DeepestOf(double least) const;

  SplitContext context_;
  SplitOptions options_;
  double mesh_area_;
  uint32_t depth_ = 0;
  SegmentTree tree_;
};

}  // namespace marrow

#endif  // MARROW_CORE_HIERARCHY_TREE_BUILDER_H_
