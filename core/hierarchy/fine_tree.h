// What was found on a coarse mesh (core/mesh/coarse_mesh.h) -> the same on the
// mesh that it was made from.
#ifndef MARROW_CORE_HIERARCHY_FINE_TREE_H_
#define MARROW_CORE_HIERARCHY_FINE_TREE_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/hierarchy/merge_tree.h"
#include "core/hierarchy/segment_tree.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/coarse_mesh.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pieces/face_links.h"

namespace marrow {

// Coarse vertices, ascending -> those of them that the fine `faces` have; a
// corner of the first face where there are none. Thread safe.
std::vector<uint32_t> ToFine(const std::vector<uint32_t>& vertices,
                             const CoarseMesh& coarse, const TriangleMesh& fine,
                             const std::vector<uint32_t>& faces);

// Nodes have the clusters of their coarse faces, and the medial structures that
// they had. Their areas and centroids are those of the coarse faces, so
// siblings are in the order of these. Thread safe.
SegmentTree ToFine(const SegmentTree& tree, const CoarseMesh& coarse,
                   const TriangleMesh& fine);

// A tree of a mesh with patches (core/mesh/patches.h) without these: nodes have
// those of their faces that are among the first `count`, and those of their
// medial structures that these have; a corner of the first where there are
// none. Thread safe.
SegmentTree WithoutPatches(const SegmentTree& tree, const TriangleMesh& mesh,
                           uint32_t count);

// The first of merged pieces, whose boundaries are made smooth on the fine mesh
// first (SmoothBoundaries(), two coarse edges to either side), unless that
// would leave a piece none of the first `count` fine faces. Errors: CANCELLED.
absl::StatusOr<MergeTree> ToFine(const MergeTree& merged,
                                 const CoarseMesh& coarse,
                                 const TriangleMesh& fine, uint32_t count,
                                 const Adjacency& adjacency,
                                 const FaceLinks& links,
                                 const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_HIERARCHY_FINE_TREE_H_
