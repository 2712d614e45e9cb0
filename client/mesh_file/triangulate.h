// A polygon -> triangles.
#ifndef MARROW_CLIENT_MESH_FILE_TRIANGULATE_H_
#define MARROW_CLIENT_MESH_FILE_TRIANGULATE_H_

#include <array>
#include <cstdint>
#include <vector>

#include "client/polygon_mesh.h"

namespace marrow {

// Appends the triangles of face f of `mesh`, as vertex indices of the mesh and
// turned as the face is. A face of n >= 3 corners gives n - 2 triangles, one
// with fewer corners none.
//
// A polygon is cut as a fan from its first corner where that leaves no triangle
// turned over, otherwise by clipping ears, so that a planar polygon that does
// not cross itself is covered once. Repeated corners give triangles with
// repeated corners; nothing is dropped. Deterministic. Thousands of corners
// take milliseconds.
void Triangulate(const PolygonMesh& mesh, size_t f,
                 std::vector<std::array<uint32_t, 3>>* triangles);

}  // namespace marrow

#endif  // MARROW_CLIENT_MESH_FILE_TRIANGULATE_H_
