#include "core/hierarchy/forest.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/hierarchy/segment_node.h"

namespace marrow {
namespace {

class Planter {
 public:
  Planter(const CanonicalMesh& mesh, const std::vector<double>& face_areas,
          const Bodies& bodies)
      : mesh_(mesh), face_areas_(face_areas), bodies_(bodies) {
    for (uint32_t f = 0; f < bodies.anchors.size(); ++f)
      if (bodies.anchors[f] != f) attached_.push_back({bodies.anchors[f], f});
    std::sort(attached_.begin(), attached_.end());
  }

  SegmentTree Plant(const std::vector<const SegmentTree*>& trees,
                    BodyRoots roots) {
    const uint32_t shift =
        trees.size() > 1 && roots == BodyRoots::kLevelOne ? 1 : 0;
    // New ids of the nodes of each tree.
    std::vector<std::vector<uint32_t>> ids(trees.size());
    if (trees.size() > 1) AddRoot(*trees[0]);
    if (trees.size() > 1 && roots == BodyRoots::kNone) {
      result_.nodes[0].salience = 1;
      for (size_t b = 0; b < trees.size(); ++b)
        if (!trees[b]->nodes[0].children.empty()) ids[b].push_back(0);
    }
    for (uint32_t level = result_.nodes.empty() ? 0 : 1, any = 1; any > 0;
         ++level) {
      any = 0;
      for (size_t b = 0; b < trees.size(); ++b)
        any += AddLevel(*trees[b], bodies_.bodies[b], level, shift, ids[b]);
    }
    return std::move(result_);
  }

 private:
  void AddRoot(const SegmentTree& largest) {
    SegmentNode& root = result_.nodes.emplace_back();
    root.faces.resize(bodies_.anchors.size());
    std::iota(root.faces.begin(), root.faces.end(), 0u);
    root.medial_structure =
        ToWholeVertices(bodies_.bodies[0], mesh_.mesh,
                        largest.nodes[0].medial_structure, root.faces);
    MeasureNode(mesh_.mesh, face_areas_, mesh_.report.area, root,
                bodies_.anchors);
  }

  // Adds what belongs to `level` of the result. Nodes of one level are
  // neighbours in a tree, so their order is kept.
  uint32_t AddLevel(const SegmentTree& tree, const Body& body, uint32_t level,
                    uint32_t shift, std::vector<uint32_t>& ids) {
    uint32_t added = 0;
    for (size_t i = ids.size();
         i < tree.nodes.size() && tree.nodes[i].level + shift <= level;
         ++i, ++added) {
      const SegmentNode& old = tree.nodes[i];
      SegmentNode node;
      node.id = static_cast<uint32_t>(result_.nodes.size());
      node.level = level;
      if (old.parent != kNoIndex) {
        node.parent = ids[old.parent];
      } else if (level > 0) {
        node.parent = 0;
      }
      if (node.parent != kNoIndex)
        result_.nodes[node.parent].children.push_back(node.id);
      node.salience = old.salience;
      node.iterations = old.iterations;
      node.stop_reason = old.stop_reason;
      node.faces = ToWhole(old.faces, body.faces);
      node.medial_structure =
          ToWholeVertices(body, mesh_.mesh, old.medial_structure, node.faces);
      node.faces = WithAttached(std::move(node.faces));
      MeasureNode(mesh_.mesh, face_areas_, mesh_.report.area, node,
                  bodies_.anchors);
      ids.push_back(node.id);
      result_.nodes.push_back(std::move(node));
    }
    return added;
  }

  static std::vector<uint32_t> ToWhole(std::vector<uint32_t> own,
                                       const std::vector<uint32_t>& whole) {
    for (uint32_t& index : own) index = whole[index];
    return own;
  }

  std::vector<uint32_t> WithAttached(std::vector<uint32_t> faces) const {
    if (attached_.empty()) return faces;
    const size_t own = faces.size();
    for (size_t i = 0; i < own; ++i)
      for (auto it = std::lower_bound(attached_.begin(), attached_.end(),
                                      std::pair(faces[i], 0u));
           it != attached_.end() && it->first == faces[i]; ++it)
        faces.push_back(it->second);
    std::sort(faces.begin(), faces.end());
    return faces;
  }

  const CanonicalMesh& mesh_;
  const std::vector<double>& face_areas_;
  const Bodies& bodies_;
  std::vector<std::pair<uint32_t, uint32_t>> attached_;  // anchor, face
  SegmentTree result_;
};

}  // namespace

SegmentTree PlantForest(const CanonicalMesh& mesh,
                        const std::vector<double>& face_areas,
                        const Bodies& bodies,
                        const std::vector<const SegmentTree*>& trees,
                        BodyRoots roots) {
  return Planter(mesh, face_areas, bodies).Plant(trees, roots);
}

}  // namespace marrow
