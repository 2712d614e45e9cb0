// What is said of a segment, whichever method found it.
#ifndef MARROW_CORE_HIERARCHY_SEGMENT_NODE_H_
#define MARROW_CORE_HIERARCHY_SEGMENT_NODE_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/hierarchy/segment_tree.h"
#include "core/pieces/split_region.h"

namespace marrow {

// Fills area and centroid from the faces. `face_areas` are shares of
// `mesh_area`. Faces that are attached, which have another anchor than
// themselves, count for the area alone: specks must not pull a joint out of the
// body. No anchors: none is attached.
void MeasureNode(const TriangleMesh& mesh,
                 const std::vector<double>& face_areas, double mesh_area,
                 SegmentNode& node, std::span<const uint32_t> anchors = {});

// A node of the piece with its area and centroid; everything else has its
// default. `mesh_area` is in units of the positions.
SegmentNode MakeNode(const SplitContext& context, double mesh_area,
                     Piece piece);

// Gives the children, in the order of siblings, the next ids and the level
// below the parent's, and appends them.
void AppendChildren(uint32_t parent, std::vector<SegmentNode> children,
                    SegmentTree& tree);

}  // namespace marrow

#endif  // MARROW_CORE_HIERARCHY_SEGMENT_NODE_H_
