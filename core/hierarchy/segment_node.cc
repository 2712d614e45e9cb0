#include "core/hierarchy/segment_node.h"

#include <Eigen/Core>
#include <algorithm>
#include <utility>

namespace marrow {

void MeasureNode(const TriangleMesh& mesh,
                 const std::vector<double>& face_areas, double mesh_area,
                 SegmentNode& node, std::span<const uint32_t> anchors) {
  double share = 0, own_share = 0;
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  Eigen::Vector3d plain = Eigen::Vector3d::Zero();
  for (uint32_t f : node.faces) {
    share += face_areas[f];
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (uint32_t v : mesh.faces[f]) centre += mesh.Position(v) / 3;
    plain += centre / static_cast<double>(node.faces.size());
    if (!anchors.empty() && anchors[f] != f) continue;
    weighted += face_areas[f] * centre;
    own_share += face_areas[f];
  }
  node.area = share * mesh_area;
  node.centroid = own_share > 0 ? Eigen::Vector3d(weighted / own_share) : plain;
}

SegmentNode MakeNode(const SplitContext& context, double mesh_area,
                     Piece piece) {
  SegmentNode node;
  node.faces = std::move(piece.faces);
  node.medial_structure = std::move(piece.medial_structure);
  MeasureNode(context.mesh, context.face_areas, mesh_area, node);
  return node;
}

void AppendChildren(uint32_t parent, std::vector<SegmentNode> children,
                    SegmentTree& tree) {
  std::sort(children.begin(), children.end(),
            [](const SegmentNode& a, const SegmentNode& b) {
              return a.area != b.area ? a.area > b.area
                                      : a.faces.front() < b.faces.front();
            });
  for (SegmentNode& child : children) {
    child.id = static_cast<uint32_t>(tree.nodes.size());
    child.parent = parent;
    child.level = tree.nodes[parent].level + 1;
    tree.nodes[parent].children.push_back(child.id);
    tree.nodes.push_back(std::move(child));
  }
}

}  // namespace marrow
