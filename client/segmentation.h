// The answers to Segment and Cut, in the order of the user's own file.
#ifndef MARROW_CLIENT_SEGMENTATION_H_
#define MARROW_CLIENT_SEGMENTATION_H_

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
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

// A cut of the tree: segments that cover the mesh once.
struct Cut {
  // Ascending ids. One with an id below `tree_nodes` is that node of the tree;
  // any other has the deepest node that holds it as parent.
  std::vector<SegmentNode> segments;
  uint32_t tree_nodes = 0;
  double salience = 0;  // what it was cut at; 0 in the paper's method
  Level level;          // its labels and its skeleton; level.level is 0
};

// The answer to one Cut call.
struct CutAnswer {
  Cut cut;
  nlohmann::json timings;
  nlohmann::json cache;
};

struct Segmentation {
  std::vector<SegmentNode> nodes;  // ordered by id
  std::vector<Level> levels;       // 1, 2, ...; never empty
  std::optional<Cut> cut;          // where it was asked for
  nlohmann::json report;           // what the server found in the mesh
  nlohmann::json timings;          // seconds a stage
  nlohmann::json cache;            // what was computed and what was kept

  // The level nearest to the automatic cut: 2, or 1 where there is no 2.
  const Level& AutomaticLevel() const {
    return levels.size() > 1 ? levels[1] : levels[0];
  }
  // Labels and skeleton of the cut; without one, of the automatic level.
  const Level& CutLevel() const {
    return cut.has_value() ? cut->level : AutomaticLevel();
  }
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_SEGMENTATION_H_
