// METHOD_MERGE for one body: pieces, merged across their weakest boundaries,
// cut at fixed saliences.
#ifndef MARROW_CORE_HIERARCHY_MERGE_TREE_H_
#define MARROW_CORE_HIERARCHY_MERGE_TREE_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/hierarchy/merge_order.h"
#include "core/hierarchy/segment_tree.h"
#include "core/pieces/split_region.h"

namespace marrow {

struct MergeTree {
  std::vector<uint32_t> piece_of_face;
  MergeOrder order;  // of those pieces
  SegmentTree tree;  // its levels are cuts of the order (level_tree.h)
};

// Sees to it that the context's pairs suffice for regions of that share of the
// mesh.
using PullCallback = std::function<absl::Status(
    double area_share, const std::function<void(double)>& progress)>;

// Pulls what the finding of the pieces takes, level by level, and nothing more:
// the medial structures of what they merge into make do with it.
//
// `options.kappa` is not looked at: pieces have their own. `mesh_area` is in
// units of the positions. Gives the first `levels` of the levels of
// core/boundaries/calibration.h, all where it has fewer. Calls `progress` with
// the share that is done. Deterministic. Errors: CANCELLED; those of `pull`.
// REQUIRES: the pairs suffice for the mesh as a whole.
absl::StatusOr<MergeTree> BuildMergeTree(
    const SplitContext& context, const SplitOptions& options, double mesh_area,
    uint32_t levels, const CancelToken& cancel, const PullCallback& pull,
    const std::function<void(double)>& progress);

}  // namespace marrow

#endif  // MARROW_CORE_HIERARCHY_MERGE_TREE_H_
