#include "core/mesh/rims.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <vector>

#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// A flat sheet of 6 x 6 squares without some of its faces.
TriangleMesh SheetWithout(const std::vector<uint32_t>& faces) {
  TriangleMesh mesh = Grid(6, 6);
  std::vector<Triangle> kept;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (std::find(faces.begin(), faces.end(), f) == faces.end())
      kept.push_back(mesh.faces[f]);
  mesh.faces = kept;
  return mesh;
}

std::vector<uint32_t> FacesAt(const TriangleMesh& mesh, double x, double y) {
  std::vector<uint32_t> faces;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    for (uint32_t v : mesh.faces[f])
      if (mesh.Position(v).x() == x && mesh.Position(v).y() == y)
        faces.push_back(f);
  return faces;
}

struct Found {
  size_t corners = 0;
  size_t edges = 0;
  std::map<uint32_t, double> angle;  // by vertex
};

Found Find(const TriangleMesh& mesh, double longest = 100) {
  const Holes holes = SmallHoles(Adjacency(mesh), mesh.positions, longest);
  Found found;
  found.corners = holes.corners.size();
  found.edges = std::count(holes.has_edge.begin(), holes.has_edge.end(), true);
  for (const auto& [vertex, angle] : holes.corners)
    found.angle[vertex] += angle;
  return found;
}

TEST(SmallHolesTest, AMissingFaceIsOne) {
  const TriangleMesh whole = Grid(6, 6);
  const uint32_t face = FacesAt(whole, 3, 3).front();
  const Found found = Find(SheetWithout({face}), 4);
  EXPECT_EQ(found.corners, 3u);
  EXPECT_EQ(found.edges, 3u);
  double sum = 0;
  for (uint32_t v : whole.faces[face]) sum += found.angle.at(v);
  EXPECT_NEAR(sum, std::numbers::pi, 1e-12);
}

TEST(SmallHolesTest, TwoThatTouchAreTwo) {
  const TriangleMesh whole = Grid(6, 6);
  const std::vector<uint32_t> around = FacesAt(whole, 3, 3);
  // Two of the six around a vertex that share no edge.
  for (uint32_t f : around) {
    const Found found = Find(SheetWithout({around[0], f}), 10);
    if (f == around[0]) continue;
    EXPECT_TRUE(found.corners == 6 || found.corners == 4) << found.corners;
    EXPECT_EQ(found.edges, found.corners);
  }
}

TEST(SmallHolesTest, AMissingFanIsOneIfShortEnough) {
  const std::vector<uint32_t> around = FacesAt(Grid(6, 6), 3, 3);
  ASSERT_EQ(around.size(), 6u);
  const TriangleMesh mesh = SheetWithout(around);
  EXPECT_EQ(Find(mesh, 7).corners, 6u);
  EXPECT_EQ(Find(mesh, 6).corners, 0u);
}

// The rim of the sheet is flat and convex; that of an L is not.
TEST(SmallHolesTest, ARaggedRimIsNone) {
  std::vector<uint32_t> faces = FacesAt(Grid(6, 6), 2, 2);
  EXPECT_EQ(Find(SheetWithout(faces), 20).corners, 6u);
  for (const auto& [x, y] : {std::pair{3, 2}, {4, 2}, {4, 3}, {4, 4}})
    for (uint32_t f : FacesAt(Grid(6, 6), x, y)) faces.push_back(f);
  EXPECT_EQ(Find(SheetWithout(faces), 20).corners, 0u);
}

TEST(SmallHolesTest, AFaceAloneIsNone) {
  TriangleMesh mesh;
  mesh.positions = Positions::Random(3, 3);
  mesh.faces = {{0, 1, 2}};
  EXPECT_EQ(Find(mesh).corners, 0u);
}

TEST(RimOfVerticesTest, IsItsLeastVertex) {
  const TriangleMesh mesh = SheetWithout(FacesAt(Grid(6, 6), 3, 3));
  const Adjacency adjacency(mesh);
  const std::vector<uint32_t> rim = RimOfVertices(adjacency);
  std::map<uint32_t, size_t> members;
  for (uint32_t v = 0; v < rim.size(); ++v) {
    EXPECT_LE(rim[v], v);
    ++members[rim[v]];
  }
  std::vector<size_t> sizes;
  for (const auto& [least, size] : members)
    if (size > 1) sizes.push_back(size);
  std::sort(sizes.begin(), sizes.end());
  EXPECT_EQ(sizes, (std::vector<size_t>{6, 24}));
}

}  // namespace
}  // namespace marrow
