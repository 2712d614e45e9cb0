#include "core/mesh/t_junctions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "core/mesh/canonical_mesh.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

constexpr uint32_t kStep = 7;

uint32_t AddVertex(const Eigen::Vector3d& place, TriangleMesh& mesh) {
  const uint32_t v = mesh.NumVertices();
  mesh.positions.conservativeResize(v + 1, 3);
  mesh.positions.row(v) = place.transpose();
  return v;
}

// Of every seventh face the first edge has a vertex inside, which the face on
// the other side does not have. `off` of the edge's length beside it.
TriangleMesh WithTJunctions(TriangleMesh mesh, double off = 0) {
  const uint32_t faces = mesh.NumFaces();
  for (uint32_t f = 0; f < faces; f += kStep) {
    const auto [a, b, c] = mesh.faces[f];
    const Eigen::Vector3d p = mesh.Position(a), q = mesh.Position(b);
    const Eigen::Vector3d aside =
        (q - p).cross(mesh.Position(c) - p).normalized() * (q - p).norm();
    const uint32_t m = AddVertex(0.4 * p + 0.6 * q + off * aside, mesh);
    mesh.faces[f] = {a, m, c};
    mesh.faces.push_back({m, b, c});
  }
  return mesh;
}

uint32_t CountOf(uint32_t faces) { return (faces + kStep - 1) / kStep; }

TEST(TJunctionsTest, AreClosed) {
  const TriangleMesh torus = Torus(3, 1, 30, 20);
  const CanonicalMesh c = CanonicalOf(WithTJunctions(torus));
  const uint32_t count = CountOf(torus.NumFaces());
  EXPECT_EQ(c.report.t_junctions, count);
  EXPECT_EQ(c.report.boundary_edges, 0u);
  EXPECT_EQ(c.report.genus, 1u);
  EXPECT_EQ(c.mesh.NumFaces(), torus.NumFaces() + 2 * count);
  EXPECT_EQ(c.report.decoded_faces, torus.NumFaces() + count);
  EXPECT_EQ(c.report.duplicate_faces, 0u);
  EXPECT_EQ(c.report.degenerate_faces, 0u);
  EXPECT_NEAR(c.report.area, CanonicalOf(torus).report.area, 1e-9);
}

// A face that is split has the label of its largest part: two of its corners
// are that part's.
TEST(TJunctionsTest, FacesKeepAPartOfTheirOwn) {
  const TriangleMesh mesh = WithTJunctions(Torus(3, 1, 30, 20));
  const CanonicalMesh c = CanonicalOf(mesh);
  std::set<uint32_t> own;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const Triangle& part = c.mesh.faces[c.face_map[f]];
    int shared = 0;
    for (uint32_t corner : mesh.faces[f])
      shared += std::ranges::count(part, c.point_map[corner]);
    EXPECT_GE(shared, 2);
    EXPECT_TRUE(own.insert(c.face_map[f]).second);
  }
}

TEST(TJunctionsTest, NumberingCannotMatter) {
  const TriangleMesh mesh = WithTJunctions(Torus(3, 1, 30, 20));
  for (uint32_t seed = 1; seed <= 5; ++seed)
    EXPECT_EQ(CanonicalOf(Renumber(mesh, seed).mesh).geometry_digest,
              CanonicalOf(mesh).geometry_digest);
}

TEST(TJunctionsTest, GapsStayOpen) {
  const TriangleMesh torus = Torus(3, 1, 30, 20);
  EXPECT_GT(CanonicalOf(WithTJunctions(torus, 0.0009)).report.t_junctions, 0u);
  EXPECT_EQ(CanonicalOf(WithTJunctions(torus, 0.0011)).report.t_junctions, 0u);
}

TEST(TJunctionsTest, CleanMeshesHaveNone) {
  for (const NamedMesh& shape : AllShapes())
    EXPECT_EQ(CanonicalOf(shape.mesh).report.t_junctions, 0u) << shape.name;
}

// A strip of triangles from `left` to `right`, with so many rungs.
TriangleMesh Strip(double left, double right, uint32_t rungs) {
  TriangleMesh mesh;
  mesh.positions.resize(0, 3);
  for (uint32_t i = 0; i <= rungs; ++i) {
    AddVertex({left, 3.0 * i / rungs, 0}, mesh);
    AddVertex({right, 3.0 * i / rungs, 0}, mesh);
  }
  for (uint32_t i = 0; i < rungs; ++i) {
    const uint32_t at = 2 * i;
    mesh.faces.push_back({at, at + 1, at + 2});
    mesh.faces.push_back({at + 1, at + 3, at + 2});
  }
  return mesh;
}

// Two tessellations that meet in a line: both get the vertices of both.
TEST(TJunctionsTest, PatchesOfOtherStepsAreSewn) {
  const CanonicalMesh c =
      CanonicalOf(Together({Strip(0, 1, 3), Strip(1, 2, 4)}));
  EXPECT_EQ(c.report.components, 1u);
  EXPECT_EQ(c.report.t_junctions, 2u + 3u);
  EXPECT_EQ(c.report.boundary_edges, 3u + 4u + 2u + 2u);
  EXPECT_EQ(c.report.euler_characteristic, 1);
}

// Parts cover the face, whichever edges are split.
TEST(TJunctionsTest, PartsCoverTheFace) {
  const TriangleMesh corners = SingleTriangle();
  for (int split = 0; split < 8; ++split) {
    TriangleMesh mesh = corners;
    TJunctions junctions;
    for (uint32_t i = 0; i < 3; ++i) {
      if ((split >> i & 1) == 0) continue;
      const uint32_t a = std::min(i, (i + 1) % 3), b = std::max(i, (i + 1) % 3);
      for (double t : {0.2, 0.5, 0.9})
        junctions[{a, b}].push_back(AddVertex(
            (1 - t) * corners.Position(a) + t * corners.Position(b), mesh));
    }
    mesh.faces = SplitAt(junctions, {0, 1, 2});
    EXPECT_EQ(mesh.faces.size(), 1 + 3 * junctions.size());
    const CanonicalMesh c = CanonicalOf(mesh);
    EXPECT_NEAR(c.report.area, CanonicalOf(corners).report.area, 1e-12);
    EXPECT_EQ(c.report.boundary_edges, 3 + 3 * junctions.size());
    EXPECT_EQ(c.report.flipped_faces, 0u);
  }
}

}  // namespace
}  // namespace marrow
