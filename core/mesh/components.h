// Components: what shared vertices connect.
#ifndef MARROW_CORE_MESH_COMPONENTS_H_
#define MARROW_CORE_MESH_COMPONENTS_H_

#include <cstdint>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Unites the corners of every face in `vertices`, which has each vertex of the
// mesh as a set of its own; how many sets are left.
inline uint32_t JoinCorners(const TriangleMesh& mesh, DisjointSets& vertices) {
  uint32_t components = mesh.NumVertices();
  for (const Triangle& face : mesh.faces)
    components -=
        vertices.Union(face[0], face[1]) + vertices.Union(face[0], face[2]);
  return components;
}

// Components in the order of their least faces, faces ascending.
inline std::vector<std::vector<uint32_t>> FacesByComponent(
    const TriangleMesh& mesh) {
  DisjointSets vertices(mesh.NumVertices());
  JoinCorners(mesh, vertices);
  std::vector<uint32_t> place(mesh.NumVertices(), kNoIndex);
  std::vector<std::vector<uint32_t>> components;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    uint32_t& at = place[vertices.Find(mesh.faces[f][0])];
    if (at == kNoIndex) {
      at = static_cast<uint32_t>(components.size());
      components.emplace_back();
    }
    components[at].push_back(f);
  }
  return components;
}

}  // namespace marrow

#endif  // MARROW_CORE_MESH_COMPONENTS_H_
