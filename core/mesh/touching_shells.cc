#include "core/mesh/touching_shells.h"

#include <algorithm>

#include "core/base/disjoint_sets.h"
#include "core/mesh/adjacency.h"

namespace marrow {
namespace {

// Face -> the least face of its shell, or kNoIndex for an open one.
std::vector<uint32_t> ClosedShells(const Adjacency& adjacency) {
  DisjointSets faces(adjacency.NumFaces());
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    for (uint32_t f : adjacency.EdgeFaces(e))
      faces.Union(adjacency.EdgeFaces(e).front(), f);
  std::vector<uint32_t> shells = faces.Representatives();
  std::vector<bool> is_open(shells.size(), false);
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    if (adjacency.IsBoundaryEdge(e))
      is_open[shells[adjacency.EdgeFaces(e).front()]] = true;
  for (uint32_t& shell : shells)
    if (is_open[shell]) shell = kNoIndex;
  return shells;
}

}  // namespace

PartedMesh PartTouchingShells(const TriangleMesh& mesh,
                              const CancelToken& cancel) {
  const Adjacency adjacency(mesh, cancel);
  PartedMesh parted;
  if (cancel.IsCancelled()) return parted;
  const std::vector<uint32_t> shells = ClosedShells(adjacency);
  parted.mesh.faces = mesh.faces;
  std::vector<uint32_t> around;
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    around.clear();
    for (uint32_t f : adjacency.VertexFaces(v)) around.push_back(shells[f]);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    if (around.size() > kMostTouching) around.resize(1);
    const auto first = static_cast<uint32_t>(parted.vertices.size());
    parted.vertices.insert(parted.vertices.end(),
                           std::max<size_t>(1, around.size()), v);
    for (uint32_t f : adjacency.VertexFaces(v)) {
      const auto at = std::find(around.begin(), around.end(), shells[f]);
      const auto copy = at == around.end() ? 0 : at - around.begin();
      for (int corner = 0; corner < 3; ++corner)
        if (mesh.faces[f][corner] == v)
          parted.mesh.faces[f][corner] = first + static_cast<uint32_t>(copy);
    }
  }
  if (parted.vertices.size() == mesh.NumVertices()) return {};
  parted.mesh.positions = mesh.positions(parted.vertices, Eigen::all);
  return parted;
}

}  // namespace marrow
