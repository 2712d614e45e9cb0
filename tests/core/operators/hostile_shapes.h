// Meshes that plain cotangents fail on.
#ifndef MARROW_TESTS_CORE_OPERATORS_HOSTILE_SHAPES_H_
#define MARROW_TESTS_CORE_OPERATORS_HOSTILE_SHAPES_H_

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "tests/testing/shapes.h"

namespace marrow {

// Every face is cut in three, in turn at a point near the middle of an edge (a
// cap of angles down to `angle`, and two halves) and at one near a corner (two
// needles). How near runs evenly in the logarithm, from 0.01 to `angle`. The
// surface stays the same.
TriangleMesh AllSlivers(const TriangleMesh& mesh, double angle);
// A square that is cut at random places and edges: closed if `closed` (then the
// two sides of a pillow), with angles near 180 degrees.
TriangleMesh RandomObtuse(uint32_t points, bool closed, uint32_t seed);
// The figure-8 immersion, which passes through itself.
TriangleMesh KleinBottle(uint32_t around, uint32_t across);
// Triangles that all share one edge, at even angles about it.
TriangleMesh Pages(uint32_t pages);
// The faces of a mesh, every second one turned over.
TriangleMesh TurnedOver(const TriangleMesh& mesh);
// Every `step`-th face twice, the second time turned over.
TriangleMesh Doubled(const TriangleMesh& mesh, uint32_t step);
// Vertices at 1, 1/ratio, 1/ratio^2, ... until 1e-12 along one edge of a
// triangle, all tied to the opposite corner: needles and caps.
TriangleMesh Cascade(double ratio);
// A disk of triangles about one vertex that lies `shift` from its centre, under
// a rim of radius 1.
TriangleMesh Fan(uint32_t triangles, double shift);
// Two fans, above and below one rim.
TriangleMesh Bipyramid(uint32_t triangles);
// `cones` cones of `around` triangles, tip to tip.
TriangleMesh Cones(uint32_t cones, uint32_t around);
// A cylinder of two rings, one turned against the other by `turns`, closed by
// fans: long twisted slivers.
TriangleMesh TwistedCan(uint32_t around, double turns);

// All of the above in small.
std::vector<NamedMesh> HostileShapes();

}  // namespace marrow

#endif  // MARROW_TESTS_CORE_OPERATORS_HOSTILE_SHAPES_H_
