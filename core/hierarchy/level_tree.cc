#include "core/hierarchy/level_tree.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include "core/base/status_macros.h"
#include "core/hierarchy/segment_node.h"
#include "core/mesh/face_areas.h"

namespace marrow {
namespace {

using Cut = std::vector<uint32_t>;  // piece -> least piece of its group

// What the growing of one tree shares.
struct Growth {
  const SplitContext& context;
  const SplitOptions& options;
  double mesh_area;
  const std::vector<uint32_t>& piece_of_face;
  const MergeOrder& order;
};

SegmentNode NodeOf(const Growth& growth, std::vector<uint32_t> faces) {
  Piece piece;
  piece.medial_structure =
      MedialStructureOf(growth.context, faces, growth.options);
  piece.faces = std::move(faces);
  return MakeNode(growth.context, growth.mesh_area, std::move(piece));
}

bool IsSplit(const Growth& growth, const SegmentNode& node, const Cut& cut) {
  const uint32_t first = cut[growth.piece_of_face[node.faces.front()]];
  for (uint32_t f : node.faces)
    if (cut[growth.piece_of_face[f]] != first) return true;
  return false;
}

// The node's parts in the cut. A part that is the whole is a copy of the node:
// its medial structure need not be found again.
std::vector<SegmentNode> PartsOf(const Growth& growth, const SegmentNode& node,
                                 const Cut& cut,
                                 const std::vector<double>& salience) {
  std::map<uint32_t, std::vector<uint32_t>> faces_of_group;
  for (uint32_t f : node.faces)
    faces_of_group[cut[growth.piece_of_face[f]]].push_back(f);
  std::vector<SegmentNode> parts;
  for (auto& [group, faces] : faces_of_group) {
    if (faces.size() == node.faces.size()) {
      Piece same{node.faces, node.medial_structure};
      parts.push_back(
          MakeNode(growth.context, growth.mesh_area, std::move(same)));
    } else {
      parts.push_back(NodeOf(growth, std::move(faces)));
    }
    parts.back().salience = salience[group];
  }
  return parts;
}

// Of the area of either, how much both have.
double CommonShare(const SegmentNode& a, const SegmentNode& b,
                   const std::vector<double>& face_areas) {
  std::vector<uint32_t> common;
  std::set_intersection(a.faces.begin(), a.faces.end(), b.faces.begin(),
                        b.faces.end(), std::back_inserter(common));
  const double both = AreaOf(common, face_areas);
  return both /
         (AreaOf(a.faces, face_areas) + AreaOf(b.faces, face_areas) - both);
}

}  // namespace

void NoteIterations(const SegmentTree& pieces,
                    const std::vector<double>& face_areas, SegmentTree& tree) {
  for (SegmentNode& node : tree.nodes) {
    if (node.children.size() < 2) continue;
    double most = 0;
    for (const SegmentNode& segment : pieces.nodes) {
      if (segment.children.empty()) continue;
      const double share = CommonShare(node, segment, face_areas);
      if (share <= most) continue;
      most = share;
      node.iterations = segment.iterations;
    }
  }
}

absl::StatusOr<SegmentTree> BuildLevelTree(
    const SplitContext& context, const SplitOptions& options, double mesh_area,
    const std::vector<uint32_t>& piece_of_face, const MergeOrder& order,
    std::span<const double> thresholds, const CancelToken& cancel) {
  const Growth growth{context, options, mesh_area, piece_of_face, order};
  SegmentTree tree;
  std::vector<uint32_t> all(piece_of_face.size());
  std::iota(all.begin(), all.end(), 0u);
  tree.nodes.push_back(NodeOf(growth, std::move(all)));
  if (!order.merges.empty())
    tree.nodes[0].salience = order.merges.back().salience;
  if (thresholds.empty()) return tree;

  const Cut finest = order.CutAt(thresholds.back());
  for (uint32_t id = 0; id < tree.nodes.size(); ++id) {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    const uint32_t level = tree.nodes[id].level;
    if (level == thresholds.size()) {
      tree.nodes[id].stop_reason = StopReason::kDepth;
    } else if (!IsSplit(growth, tree.nodes[id], finest)) {
      tree.nodes[id].stop_reason = StopReason::kOneSegment;
    } else {
      const Cut cut = order.CutAt(thresholds[level]);
      AppendChildren(
          id, PartsOf(growth, tree.nodes[id], cut, order.InnerSalience(cut)),
          tree);
    }
  }
  return tree;
}

}  // namespace marrow
