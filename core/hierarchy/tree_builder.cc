#include "core/hierarchy/tree_builder.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/status_macros.h"

namespace marrow {

std::vector<uint32_t> SegmentTree::SegmentsAtLevel(uint32_t level) const {
  std::vector<uint32_t> segments;
  for (const SegmentNode& node : nodes)
    if (node.level == level || (node.level < level && node.children.empty()))
      segments.push_back(node.id);
  return segments;
}

std::vector<uint32_t> SegmentTree::FaceSegments(uint32_t level) const {
  std::vector<uint32_t> segment_of_face(nodes[0].faces.size(), 0);
  for (uint32_t id : SegmentsAtLevel(level))
    for (uint32_t f : nodes[id].faces) segment_of_face[f] = id;
  return segment_of_face;
}

TreeBuilder::TreeBuilder(const SplitContext& context,
                         const SplitOptions& options, double mesh_area)
    : context_(context), options_(options), mesh_area_(mesh_area) {
  Piece whole;
  whole.faces.resize(context.mesh.NumFaces());
  std::iota(whole.faces.begin(), whole.faces.end(), 0u);
  whole.medial_structure = MedialStructureOf(context, whole.faces, options);
  tree_.nodes.push_back(MakeNode(kNoIndex, std::move(whole)));
}

absl::StatusOr<bool> TreeBuilder::Deepen(
    const CancelToken& cancel, const std::function<void(double)>& progress) {
  std::vector<uint32_t> leaves;
  for (const SegmentNode& node : tree_.nodes)
    if (node.level == depth_) leaves.push_back(node.id);
  bool any = false;
  double tried = 0;
  for (uint32_t id : leaves) {
    MARROW_ASSIGN_OR_RETURN(
        RegionSplit split,
        SplitRegion(context_, tree_.nodes[id].faces, options_, cancel));
    any |= !split.pieces.empty();
    AddChildren(id, std::move(split));
    tried += tree_.nodes[id].area / mesh_area_;
    if (progress) progress(std::min(1.0, tried));
  }
  if (any) ++depth_;
  return any;
}

void TreeBuilder::StopAtDepth() {
  for (SegmentNode& node : tree_.nodes)
    if (node.level == depth_ && node.stop_reason == StopReason::kNone)
      node.stop_reason = StopReason::kDepth;
}

void TreeBuilder::AddChildren(uint32_t parent, RegionSplit split) {
  tree_.nodes[parent].iterations = split.iterations;
  tree_.nodes[parent].stop_reason = split.stop_reason;
  std::vector<SegmentNode> children;
  for (Piece& piece : split.pieces)
    children.push_back(MakeNode(parent, std::move(piece)));
  std::sort(children.begin(), children.end(),
            [](const SegmentNode& a, const SegmentNode& b) {
              return a.area != b.area ? a.area > b.area
                                      : a.faces.front() < b.faces.front();
            });
  for (SegmentNode& child : children) {
    child.id = static_cast<uint32_t>(tree_.nodes.size());
    tree_.nodes[parent].children.push_back(child.id);
    tree_.nodes.push_back(std::move(child));
  }
}

SegmentNode TreeBuilder::MakeNode(uint32_t parent, Piece piece) const {
  SegmentNode node;
  node.parent = parent;
  if (parent != kNoIndex) node.level = tree_.nodes[parent].level + 1;
  node.faces = std::move(piece.faces);
  node.medial_structure = std::move(piece.medial_structure);
  MeasureNode(context_.mesh, context_.face_areas, mesh_area_, node);
  return node;
}

void MeasureNode(const TriangleMesh& mesh,
                 const std::vector<double>& face_areas, double mesh_area,
                 SegmentNode& node) {
  double share = 0;
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  Eigen::Vector3d plain = Eigen::Vector3d::Zero();
  for (uint32_t f : node.faces) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (uint32_t v : mesh.faces[f]) centre += mesh.Position(v) / 3;
    weighted += face_areas[f] * centre;
    plain += centre / static_cast<double>(node.faces.size());
    share += face_areas[f];
  }
  node.area = share * mesh_area;
  node.centroid = share > 0 ? Eigen::Vector3d(weighted / share) : plain;
}

}  // namespace marrow
