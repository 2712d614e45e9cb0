// The tree of METHOD_MERGE: cuts of merged pieces, one under the other.
#ifndef MARROW_CORE_HIERARCHY_LEVEL_TREE_H_
#define MARROW_CORE_HIERARCHY_LEVEL_TREE_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/hierarchy/merge_order.h"
#include "core/hierarchy/segment_tree.h"
#include "core/pieces/split_region.h"

namespace marrow {

// A tree whose nodes of level k are the groups of the cut at thresholds[k - 1].
// A group that no deeper cut splits is a leaf; one that a cut leaves whole and
// a deeper one splits is its own only child. `mesh_area` is in units of the
// positions.
// REQUIRES: thresholds fall; piece_of_face numbers the order's pieces.
// Errors: CANCELLED.
absl::StatusOr<SegmentTree> BuildLevelTree(
    const SplitContext& context, const SplitOptions& options, double mesh_area,
    const std::vector<uint32_t>& piece_of_face, const MergeOrder& order,
    std::span<const double> thresholds, const CancelToken& cancel);

// Gives every node that is split the iterations of a split of `pieces`, the
// tree whose leaves were merged: of the segment that has most in common with
// the node, as a share of the area of both. Both trees have the same faces.
void NoteIterations(const SegmentTree& pieces,
                    const std::vector<double>& face_areas, SegmentTree& tree);

}  // namespace marrow

#endif  // MARROW_CORE_HIERARCHY_LEVEL_TREE_H_
