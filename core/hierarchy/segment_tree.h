// The tree of segments: pure data.
#ifndef MARROW_CORE_HIERARCHY_SEGMENT_TREE_H_
#define MARROW_CORE_HIERARCHY_SEGMENT_TREE_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/pieces/split_region.h"

namespace marrow {

// A segment. Lengths and areas in the payload's units; vertices and faces are
// those of the canonical mesh.
struct SegmentNode {
  uint32_t id = 0;
  uint32_t parent = kNoIndex;  // kNoIndex for the root
  uint32_t level = 0;          // 0 for the root
  double area = 0;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // of its surface
  std::vector<uint32_t> medial_structure;              // ascending
  std::vector<uint32_t> faces;                         // ascending
  // How strong the strongest boundary inside it is, 0 to 1; never above its
  // parent's. 0 where there is none, and in the paper's method.
  double salience = 0;

  // Set when the node was tried for the level below it.
  std::vector<uint32_t> children;  // ascending ids
  uint32_t iterations = 0;
  StopReason stop_reason = StopReason::kNone;
};

// Invariants: nodes[i].id == i; node 0 is the root and has every face; the
// faces of a node's children partition the node's (an only child has them
// all); every parent's id is less than its children's; siblings are ordered by
// falling area, then least face, as they were on what was computed on: without
// what is attached, with patches (operators/bodies.h), by the coarse mesh where
// there is one.
struct SegmentTree {
  std::vector<SegmentNode> nodes;

  // The leaves of the tree cut at `level`: nodes of that level, and nodes
  // without children above it. Ascending.
  std::vector<uint32_t> SegmentsAtLevel(uint32_t level) const;
  // Face -> its segment among SegmentsAtLevel(level).
  std::vector<uint32_t> FaceSegments(uint32_t level) const;
};

}  // namespace marrow

#endif  // MARROW_CORE_HIERARCHY_SEGMENT_TREE_H_
