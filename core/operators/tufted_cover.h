// How the sides of a mesh's triangles are glued in pairs, so that they form a
// closed, consistently oriented surface on which edges can be flipped.
#ifndef MARROW_CORE_OPERATORS_TUFTED_COVER_H_
#define MARROW_CORE_OPERATORS_TUFTED_COVER_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Side 3 t + i of triangle t runs from its corner i to the next.
struct GluedTriangles {
  std::vector<uint32_t> corners;  // 3 a triangle: vertices of the mesh
  // A pair of sides that run between the same two vertices, in opposite
  // directions; every side is in one pair.
  std::vector<std::array<uint32_t, 2>> edges;
  std::vector<uint32_t> mesh_edge;  // parallel to `edges`
  uint32_t sheets = 1;              // triangles a face of the mesh
};

// Whether every edge has two faces that run along it in opposite directions: a
// closed manifold (but for its vertices) whose faces agree in orientation.
bool IsClosedAndOriented(const TriangleMesh& mesh, const Adjacency& adjacency);

// Triangle f is face f. REQUIRES: IsClosedAndOriented(mesh, adjacency).
GluedTriangles GlueFaces(const TriangleMesh& mesh, const Adjacency& adjacency);

// The tufted cover (Sharp and Crane 2020, "A Laplacian for Nonmanifold Triangle
// Meshes", section 3): triangles 2 f and 2 f + 1 are the front and the back of
// face f. At an edge the sheets are sorted by their angle about it, and what
// faces each other between two neighbours is glued: the skin of the mesh, were
// it a little thick. At a boundary front and back are glued to each other. So
// any mesh has a cover, whatever its orientation; the order is the same from
// either end of an edge. O(k log k) for an edge of k faces.
GluedTriangles GlueTuftedCover(const TriangleMesh& mesh,
                               const Adjacency& adjacency);

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_TUFTED_COVER_H_
