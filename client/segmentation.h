// The answer to one Segment call, in the order of the user's own file.
#ifndef MARROW_CLIENT_SEGMENTATION_H_
#define MARROW_CLIENT_SEGMENTATION_H_

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace marrow::client {

using Point3 = std::array<double, 3>;

// "No node, joint or label": the parent of a root, the label of a vertex that
// no face uses.
inline constexpr uint32_t kNone = 0xFFFFFFFFu;

// A node of the tree of segments. Lengths and areas are in the file's units.
struct SegmentNode {
  uint32_t id = 0;
  uint32_t parent = kNone;
  std::vector<uint32_t> children;
  uint32_t level = 0;  // 0 is the root, the whole mesh
  double area = 0;
  Point3 centroid{};                       // centre of mass of its surface
  std::vector<uint32_t> medial_structure;  // vertices of the user's file
  uint32_t iterations = 0;  // of the relaxation that split it; 0 for a leaf
  // Strength of the strongest boundary inside it; 0 in the paper's method.
  double salience = 0;
  std::string stop_reason;  // why it has no children; empty where it has
};

struct Joint {
  uint32_t id = 0;            // position in Skeleton::joints
  uint32_t parent = kNone;    // kNone for the root, which is joint 0
  bool articulation = false;  // centre of a boundary, else centre of a segment
  Point3 position{};
  // The segment whose centre this is, or the two that meet here.
  std::vector<uint32_t> segments;
};

// A rooted tree: every joint but the root has its parent before it, and the
// bone from parent to joint.
struct Skeleton {
  std::vector<Joint> joints;
};

struct Level {
  uint32_t level = 0;                   // 1 is the coarsest
  std::vector<uint32_t> face_labels;    // a node id a face of the file
  std::vector<uint32_t> vertex_labels;  // a node id a vertex, or kNone
  Skeleton skeleton;
};

struct Segmentation {
  std::vector<SegmentNode> nodes;  // ordered by id
  std::vector<Level> levels;       // 1, 2, ...; never empty
  nlohmann::json report;           // what the server found in the mesh
  nlohmann::json timings;          // seconds a stage
  nlohmann::json cache;            // what was computed and what was kept

  // The level that the automatic cut shows: 2, or 1 where there is no 2.
  const Level& AutomaticCut() const {
    return levels.size() > 1 ? levels[1] : levels[0];
  }
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_SEGMENTATION_H_
