// Whether the faces of a mesh agree on what is outside.
#ifndef MARROW_CORE_MESH_ORIENTATION_H_
#define MARROW_CORE_MESH_ORIENTATION_H_

#include <cstdint>

#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

struct Orientation {
  // The least number of faces to turn over, so that no two that share an edge
  // alone run along it in one direction. One-sided parts are left out.
  uint64_t flipped_faces = 0;
  bool orientable = true;  // no part is one-sided
};

// Parts are joined through edges of two faces. O(n log n). Thread safe.
Orientation CheckOrientation(const TriangleMesh& mesh,
                             const Adjacency& adjacency);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_ORIENTATION_H_
