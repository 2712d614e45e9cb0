#include "core/operators/seams.h"

#include <numeric>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/mesh/adjacency.h"
#include "core/operators/body_tree.h"

namespace marrow {
namespace {

// For each of the rim's vertices the place in `rim` of the nearest one of
// another component; its own place where there is none.
std::vector<uint32_t> NearestAcross(const TriangleMesh& mesh,
                                    const std::vector<uint32_t>& rim,
                                    double longest) {
  DisjointSets sets(mesh.NumVertices());
  for (const Triangle& face : mesh.faces) {
    sets.Union(face[0], face[1]);
    sets.Union(face[0], face[2]);
  }
  const UnitPoints box = ToUnitBox(mesh);
  Positions points(rim.size(), 3);
  std::vector<uint32_t> component(rim.size());
  for (size_t i = 0; i < rim.size(); ++i) {
    points.row(i) = box.points.row(rim[i]);
    component[i] = sets.Find(rim[i]);
  }
  BodyTree tree(std::move(points));
  tree.SetBodies(component);
  const double reach = longest / box.unit;
  std::vector<uint32_t> across(rim.size());
  for (uint32_t i = 0; i < rim.size(); ++i) {
    Candidate nearest{reach * reach};
    tree.Improve(i, nearest);
    across[i] = !nearest.IsBridge()    ? i
                : nearest.ends[0] == i ? nearest.ends[1]
                                       : nearest.ends[0];
  }
  return across;
}

}  // namespace

std::vector<uint32_t> SewRims(const TriangleMesh& mesh, double longest) {
  const Adjacency adjacency(mesh);
  const std::vector<uint32_t> rim = RimVertices(adjacency);
  std::vector<uint32_t> sewn(mesh.NumVertices());
  std::iota(sewn.begin(), sewn.end(), 0u);
  if (rim.empty()) return sewn;
  const std::vector<uint32_t> across = NearestAcross(mesh, rim, longest);
  DisjointSets sets(mesh.NumVertices());
  for (uint32_t i = 0; i < rim.size(); ++i)
    if (across[across[i]] == i) sets.Union(rim[i], rim[across[i]]);
  // Whether the two, made one, would be two corners of a face.
  const auto share_face = [&](uint32_t u, uint32_t v) {
    for (uint32_t f : adjacency.VertexFaces(u))
      for (uint32_t w : mesh.faces[f])
        if (w != u && sets.Find(w) == sets.Find(v)) return true;
    return false;
  };
  for (uint32_t i = 0; i < rim.size(); ++i)
    if (across[across[i]] != i && !share_face(rim[i], rim[across[i]]))
      sets.Union(rim[i], rim[across[i]]);
  for (uint32_t v : rim) sewn[v] = sets.Find(v);
  return sewn;
}

}  // namespace marrow
