// Points that stand for a surface where distances between surfaces are
// measured.
#ifndef MARROW_CORE_OPERATORS_SURFACE_POINTS_H_
#define MARROW_CORE_OPERATORS_SURFACE_POINTS_H_

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Points on coarse faces, by whose corners alone one could not tell that a
// leg of twelve faces stands in a trunk of twelve.
struct FacePoints {
  Positions places;              // a row a point
  std::vector<uint32_t> face;    // of each
  std::vector<uint32_t> corner;  // the vertex that it counts for
};

// Of every face with an edge of more than twice `near`, on a grid no coarser
// than two thirds of it, so that on two faces that touch some points are nearer
// than `near`. `places` has a row a vertex, whose unit is that of `near`. None
// where that would be very many, as on long slivers. Deterministic, linear in
// the faces and the points.
FacePoints PointsInFaces(const TriangleMesh& mesh, const Positions& places,
                         double near);

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_SURFACE_POINTS_H_
