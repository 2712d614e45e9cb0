#include "core/mesh/touching_shells.h"

#include <algorithm>

#include "core/base/disjoint_sets.h"
#include "core/mesh/adjacency.h"

namespace marrow {
namespace {

// Of what goes on sharing its vertices; else the least face of a shell, and 1.
constexpr uint32_t kShared = 0;

// By face.
std::vector<uint32_t> Shells(const Adjacency& adjacency,
                             const std::vector<double>& face_shares,
                             double least_share) {
  const uint32_t count = adjacency.NumFaces();
  DisjointSets faces(count);
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    for (uint32_t f : adjacency.EdgeFaces(e))
      faces.Union(adjacency.EdgeFaces(e).front(), f);
  std::vector<uint32_t> shells = faces.Representatives();
  std::vector<double> share(count, 0);
  for (uint32_t f = 0; f < count; ++f) share[shells[f]] += face_shares[f];
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    if (adjacency.IsBoundaryEdge(e))
      share[shells[adjacency.EdgeFaces(e).front()]] = -1;
  for (uint32_t& shell : shells)
    shell = share[shell] >= least_share ? shell + 1 : kShared;
  return shells;
}

// Those around a vertex, ascending.
void ShellsAround(const Adjacency& adjacency,
                  const std::vector<uint32_t>& shells, uint32_t v,
                  std::vector<uint32_t>& around) {
  around.clear();
  for (uint32_t f : adjacency.VertexFaces(v)) around.push_back(shells[f]);
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
}

// Shells that share one vertex as it is are one everywhere: parted elsewhere,
// they would be bridged nowhere.
void JoinWhereTooManyMeet(const Adjacency& adjacency,
                          std::vector<uint32_t>& shells) {
  DisjointSets joined(adjacency.NumFaces() + 1);
  std::vector<uint32_t> around;
  for (uint32_t v = 0; v < adjacency.NumVertices(); ++v) {
    ShellsAround(adjacency, shells, v, around);
    if (around.size() <= kMostTouching) continue;
    for (uint32_t shell : around) joined.Union(around.front(), shell);
  }
  for (uint32_t& shell : shells) shell = joined.Find(shell);
}

}  // namespace

PartedMesh PartTouchingShells(const TriangleMesh& mesh,
                              const std::vector<double>& face_shares,
                              double least_share, const CancelToken& cancel) {
  const Adjacency adjacency(mesh, cancel);
  PartedMesh parted;
  if (cancel.IsCancelled()) return parted;
  std::vector<uint32_t> shells = Shells(adjacency, face_shares, least_share);
  JoinWhereTooManyMeet(adjacency, shells);
  parted.mesh.faces = mesh.faces;
  std::vector<uint32_t> around;
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    if (cancel.IsCancelled()) return {};
    ShellsAround(adjacency, shells, v, around);
    const auto first = static_cast<uint32_t>(parted.vertices.size());
    parted.vertices.insert(parted.vertices.end(),
                           std::max<size_t>(1, around.size()), v);
    for (uint32_t f : adjacency.VertexFaces(v)) {
      const auto own =
          first + static_cast<uint32_t>(std::ranges::find(around, shells[f]) -
                                        around.begin());
      for (int corner = 0; corner < 3; ++corner)
        if (mesh.faces[f][corner] == v) parted.mesh.faces[f][corner] = own;
    }
  }
  if (parted.vertices.size() == mesh.NumVertices()) return {};
  parted.mesh.positions = mesh.positions(parted.vertices, Eigen::all);
  return parted;
}

}  // namespace marrow
