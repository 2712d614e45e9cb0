// The pieces of all bodies of a mesh, and the one order in which they merge.
#ifndef MARROW_CORE_HIERARCHY_MERGED_PIECES_H_
#define MARROW_CORE_HIERARCHY_MERGED_PIECES_H_

#include <cstdint>
#include <vector>

#include "core/hierarchy/merge_order.h"
#include "core/hierarchy/merge_tree.h"
#include "core/operators/bodies.h"

namespace marrow {

struct MergedPieces {
  std::vector<uint32_t> piece_of_face;  // faces of the whole mesh
  MergeOrder order;
};

// Numbers the pieces body by body. Merges of equal salience come in the order
// of the bodies, and no merge joins two bodies. An attached face is of the
// piece that its anchor is of. REQUIRES: a tree for each body.
MergedPieces JoinPieces(const Bodies& bodies,
                        const std::vector<MergeTree>& trees);

}  // namespace marrow

#endif  // MARROW_CORE_HIERARCHY_MERGED_PIECES_H_
