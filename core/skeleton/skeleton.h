// Segments of one level -> a rooted tree of joints and bones (the paper's
// Fig. 10): centres of mass joined through the centres of shared boundaries.
#ifndef MARROW_CORE_SKELETON_SKELETON_H_
#define MARROW_CORE_SKELETON_SKELETON_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/hierarchy/segment_tree.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

struct Joint {
  uint32_t parent = kNoIndex;  // index among the joints, less than its own
  bool articulation = false;   // centre of a boundary, else of a segment
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // payload's units
  // The segment whose centre this is, or the parent's and the child's.
  std::vector<uint32_t> segments;
};

// joints[0] is the root; every joint's parent stands before it. Every segment
// of the level has exactly one joint that is its centre.
struct Skeleton {
  std::vector<Joint> joints;
};

// The root is the segment that holds the root node's medial structure, the most
// central points of the mesh. Every other segment hangs on its shortest way to
// the root through centres and boundaries, mere contacts left out. Where two
// segments share no edge, the bridges between them (pairs of vertices that are
// near, operators/bridges.h) are their boundary. Segments without either hang
// on the nearest centre, without an articulation.
Skeleton BuildSkeleton(const TriangleMesh& mesh, const Adjacency& adjacency,
                       const SegmentTree& tree, uint32_t level,
                       std::span<const std::array<uint32_t, 2>> bridges = {});

// Segments that cover a mesh, from whatever cut.
struct SegmentCover {
  std::vector<uint32_t> ids;             // ascending
  std::vector<uint32_t> place_of_face;   // face -> index of its id
  std::vector<Eigen::Vector3d> centres;  // of mass, of each
};

// The same of any segments; `centre_of_mesh` is the whole mesh's medial
// structure.
Skeleton BuildSkeleton(const TriangleMesh& mesh, const Adjacency& adjacency,
                       const SegmentCover& cover,
                       const std::vector<uint32_t>& centre_of_mesh,
                       std::span<const std::array<uint32_t, 2>> bridges);

}  // namespace marrow

#endif  // MARROW_CORE_SKELETON_SKELETON_H_
