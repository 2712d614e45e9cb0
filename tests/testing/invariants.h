// What holds of every result, whatever the mesh; failures are reported to
// googletest.
#ifndef MARROW_TESTS_TESTING_INVARIANTS_H_
#define MARROW_TESTS_TESTING_INVARIANTS_H_

#include <cstdint>
#include <vector>

#include "core/hierarchy/segment_tree.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"
#include "core/skeleton/skeleton.h"

namespace marrow {

// Number of edge-connected pieces that the faces form, or they and all faces
// from the number `first_patch` on.
uint32_t CountPieces(const Adjacency& adjacency,
                     const std::vector<uint32_t>& faces,
                     uint32_t first_patch = kNoIndex);

// The vertices of the faces, ascending.
std::vector<uint32_t> VerticesOf(const TriangleMesh& mesh,
                                 const std::vector<uint32_t>& faces);

// The invariants of segment_tree.h, and that every segment is in one piece
// where its parent is, what patches join (core/operators/bodies.h) being one.
// `finished`: every leaf tells why it is one. `merged`:
// the tree is one of merged pieces, else of the paper's recursion. `mesh_area`
// in the units of the positions.
void ExpectSoundTree(const TriangleMesh& mesh, const Adjacency& adjacency,
                     const SegmentTree& tree, double mesh_area, bool finished,
                     bool merged = false);

// The promises of skeleton.h.
void ExpectSoundSkeleton(const TriangleMesh& mesh, const Adjacency& adjacency,
                         const SegmentTree& tree, uint32_t level,
                         const Skeleton& skeleton);

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_INVARIANTS_H_
