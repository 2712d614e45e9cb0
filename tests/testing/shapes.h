// Shapes made in code for the tests: those whose spectrum is known, those that
// have parts, and those that are trouble. All are deterministic.
#ifndef MARROW_TESTS_TESTING_SHAPES_H_
#define MARROW_TESTS_TESTING_SHAPES_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "core/mesh/canonical_mesh.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

TriangleMesh SingleTriangle();  // equilateral, side 1
TriangleMesh Tetrahedron();     // regular

// The unit sphere with 20 * 4^subdivisions faces.
TriangleMesh Icosphere(uint32_t subdivisions);
// The torus of revolution about z, `around` by `across` vertices.
TriangleMesh Torus(double big_radius, double small_radius, uint32_t around,
                   uint32_t across);
// The unit disk in the plane: a centre and rings of 6, 12, 18, ... vertices.
TriangleMesh Disk(uint32_t rings);
// A flat rectangle of columns by rows unit squares of two triangles.
TriangleMesh Grid(uint32_t columns, uint32_t rows);
// Two balls of radius 1 (right) and `left` about x, joined by a thin neck; of
// genus 0. `around` is the number of vertices of a ring.
TriangleMesh Dumbbell(double left, uint32_t around);
// The boundary of a set of unit cubes, each side cut into fineness^2 squares.
TriangleMesh CubesSurface(const std::set<std::array<int, 3>>& cubes,
                          int fineness);
// The same cubes, each with a boundary of its own: flush shells.
TriangleMesh CubeShells(const std::set<std::array<int, 3>>& cubes,
                        int fineness);
// A trunk of cubes and two arms on it of a grid twice as fine: shells that
// share some vertices and no edge.
TriangleMesh TouchingGrids();
// A ball-like body with four limbs of different lengths: a creature of
// `fineness`^2 squares a unit of its surface, slightly rounded.
TriangleMesh LimbCross(uint32_t fineness);

// Pages of `rows` squares that all meet at one spine.
TriangleMesh Book(uint32_t pages, uint32_t rows);
// Two disks that share one vertex.
TriangleMesh Bowtie(uint32_t rings);
// A band with half a turn, of `columns` squares by two.
TriangleMesh Moebius(uint32_t columns);
// One mesh of several, each where it is.
TriangleMesh Together(const std::vector<TriangleMesh>& meshes);
// One mesh of two, side by side without contact.
TriangleMesh Apart(const TriangleMesh& a, const TriangleMesh& b);
// Every `step`-th face is cut in three at a point `height` from the middle of
// its first edge (as a share of the face's height): one needle each. At 0 the
// needle has no area.
TriangleMesh WithSlivers(const TriangleMesh& mesh, uint32_t step,
                         double height);

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};
// The name as googletest wants it for a parameter.
std::string TestNameOf(const NamedMesh& shape);
// Small ones of all of the above: what any mesh must survive.
std::vector<NamedMesh> AllShapes();

struct Renumbering {
  TriangleMesh mesh;
  std::vector<uint32_t> old_vertex;  // new -> old
  std::vector<uint32_t> old_face;    // new -> old
};
// The same surface with vertices and faces shuffled and corners rotated.
Renumbering Renumber(const TriangleMesh& mesh, uint32_t seed);

TriangleMesh Rotated(const TriangleMesh& mesh, const Eigen::Vector3d& axis,
                     double radians);
TriangleMesh Scaled(const TriangleMesh& mesh, double factor);
// Rounds the positions to float, as a file does.
TriangleMesh Rounded(const TriangleMesh& mesh);

// REQUIRES: the mesh has area.
CanonicalMesh CanonicalOf(const TriangleMesh& mesh);

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_SHAPES_H_
