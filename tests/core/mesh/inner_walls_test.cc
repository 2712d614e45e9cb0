#include "core/mesh/inner_walls.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/canonical_mesh.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using Cubes = std::set<std::array<int, 3>>;

Cubes Block(int x, int y, int z) {
  Cubes cubes;
  for (int i = 0; i < x; ++i)
    for (int j = 0; j < y; ++j)
      for (int k = 0; k < z; ++k) cubes.insert({i, j, k});
  return cubes;
}

Cubes Moved(const Cubes& cubes, int dx, int dy, int dz) {
  Cubes moved;
  for (const auto& [x, y, z] : cubes) moved.insert({x + dx, y + dy, z + dz});
  return moved;
}

// Every face has its mirror's vertices in common with it, so that those of
// squares which lie back to back become twins. Faces come as halves of squares.
TriangleMesh OtherDiagonals(TriangleMesh mesh) {
  for (uint32_t f = 0; f < mesh.NumFaces(); f += 2) {
    const auto [a, b, c] = mesh.faces[f];
    const uint32_t d = mesh.faces[f + 1][2];
    mesh.faces[f] = {b, c, d};
    mesh.faces[f + 1] = {b, d, a};
  }
  return mesh;
}

void TurnOver(TriangleMesh& mesh) {
  for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
}

struct Case {
  std::string name;
  TriangleMesh first, second;
};

// A body of eight cubes, and a head of one on it: five of six sides of the
// head, and all but one square of the body's surface are outside.
std::vector<Case> BodiesWithHeads() {
  const TriangleMesh body = CubesSurface(Block(2, 2, 2), 3);
  const TriangleMesh head = CubesSurface(Moved(Block(1, 1, 1), 0, 0, 2), 3);
  std::vector<Case> cases = {{"other diagonals", body, head},
                             {"twins", body, OtherDiagonals(head)},
                             {"inside out", body, head},
                             {"twins inside out", body, OtherDiagonals(head)},
                             {"askew", body, head}};
  for (size_t i : {2, 3}) {
    TurnOver(cases[i].first);
    TurnOver(cases[i].second);
  }
  for (TriangleMesh* mesh : {&cases[4].first, &cases[4].second})
    *mesh = Rounded(Rotated(*mesh, {1, 2, 3}, 0.7));
  return cases;
}

TEST(InnerWallsTest, AreLeftOutWhereShellsLieFlush) {
  for (const auto& [name, body, head] : BodiesWithHeads()) {
    SCOPED_TRACE(name);
    const CanonicalMesh c = CanonicalOf(Together({body, head}));
    EXPECT_EQ(c.report.inner_wall_faces, 2u * 2 * 9);
    EXPECT_EQ(c.report.duplicate_faces, 0u);
    EXPECT_EQ(c.report.faces, body.NumFaces() + head.NumFaces() - 2 * 2 * 9u);
    EXPECT_EQ(c.report.nonmanifold_edges, 0u);
    EXPECT_EQ(c.report.boundary_edges, 0u);
    EXPECT_EQ(c.report.genus, 0u);
    EXPECT_EQ(c.report.components, 1u);
  }
}

// The lid that the head has below goes with the head, the body's with the body.
TEST(InnerWallsTest, HaveAFaceOfTheirShellBesideThem) {
  const auto [name, body, head] = BodiesWithHeads()[1];
  const TriangleMesh both = Together({body, head});
  const CanonicalMesh c = CanonicalOf(both);
  const auto is_lid = [&](uint32_t f) {
    const Triangle& corners = both.faces[f];
    return std::all_of(corners.begin(), corners.end(),
                       [&](uint32_t v) { return both.positions(v, 2) == 2; });
  };
  std::vector<uint32_t> heads(c.mesh.NumFaces(), kNoIndex);
  for (uint32_t f = 0; f < both.NumFaces(); ++f)
    if (!is_lid(f)) heads[c.face_map[f]] = f >= body.NumFaces();
  uint32_t lids = 0;
  for (uint32_t f = 0; f < both.NumFaces(); ++f) {
    if (!is_lid(f)) continue;
    // The body's surface goes on around the head in the plane of the wall.
    if (heads[c.face_map[f]] == kNoIndex) continue;
    EXPECT_EQ(heads[c.face_map[f]], f >= body.NumFaces()) << f;
    ++lids;
  }
  EXPECT_GT(lids, 0u);
}

TEST(InnerWallsTest, VoxelsAreTheirSurface) {
  const Cubes cubes = Block(3, 2, 4);
  const CanonicalMesh c = CanonicalOf(CubeShells(cubes, 2));
  const CanonicalMesh surface = CanonicalOf(CubesSurface(cubes, 2));
  EXPECT_EQ(c.geometry_digest, surface.geometry_digest);
  EXPECT_EQ(c.mesh.faces, surface.mesh.faces);
  for (uint32_t f : c.face_map) EXPECT_LT(f, c.mesh.NumFaces());
  // A point inside has no value, as one that no face uses.
  EXPECT_GT(std::count(c.point_map.begin(), c.point_map.end(), kNoIndex), 0);
}

TEST(InnerWallsTest, NumbersDoNotMatter) {
  for (const auto& [name, body, head] : BodiesWithHeads()) {
    SCOPED_TRACE(name);
    const TriangleMesh both = Together({body, head});
    const CanonicalMesh expected = CanonicalOf(both);
    for (uint32_t seed : {1, 2, 3}) {
      const Renumbering renumbered = Renumber(both, seed);
      const CanonicalMesh c = CanonicalOf(renumbered.mesh);
      EXPECT_EQ(c.geometry_digest, expected.geometry_digest);
      EXPECT_EQ(c.report.inner_wall_faces, expected.report.inner_wall_faces);
      for (uint32_t f = 0; f < both.NumFaces(); ++f)
        EXPECT_EQ(c.face_map[f], expected.face_map[renumbered.old_face[f]]);
    }
  }
}

// What is no wall stays: without it the surface would have a rim.
TEST(InnerWallsTest, SheetsAndTwinsStay) {
  const TriangleMesh body = CubesSurface(Block(2, 2, 2), 3);
  TriangleMesh twin = body;
  TurnOver(twin);
  EXPECT_EQ(CanonicalOf(Together({body, twin})).report.inner_wall_faces, 0u);
  EXPECT_EQ(CanonicalOf(Together({body, body})).report.inner_wall_faces, 0u);
  // Half of it twice.
  twin.faces.resize(twin.faces.size() / 2);
  EXPECT_EQ(CanonicalOf(Together({body, twin})).report.inner_wall_faces, 0u);
  // A cape of two sides, which hangs from an edge of the body.
  TriangleMesh cape = Grid(6, 5);
  cape.positions /= 3;
  TriangleMesh lining = OtherDiagonals(cape);
  TurnOver(lining);
  for (TriangleMesh* sheet : {&cape, &lining}) {
    sheet->positions.rowwise() -= Eigen::RowVector3d(0, 5.0 / 3, 0);
    const CanonicalMesh c = CanonicalOf(Together({body, cape, *sheet}));
    EXPECT_EQ(c.report.inner_wall_faces, 0u);
  }
}

// What is outside stays, though the surface would be closed without it.
TEST(InnerWallsTest, WhatIsOutsideStays) {
  const TriangleMesh body = CubesSurface(Block(2, 2, 2), 2);
  // A hat of two sides: a cube without its floor.
  TriangleMesh hat = CubesSurface({{0, 0, 2}}, 2);
  std::erase_if(hat.faces, [&](const Triangle& f) {
    return hat.positions(f[0], 2) == 2 && hat.positions(f[1], 2) == 2 &&
           hat.positions(f[2], 2) == 2;
  });
  TriangleMesh lining = hat;
  TurnOver(lining);
  // A shell that is there twice, and touches the body along an edge.
  const TriangleMesh cube = CubesSurface({{2, 0, 2}}, 2);
  TriangleMesh turned = cube;
  TurnOver(turned);
  // A cube inside of a body, flush with its skin.
  const TriangleMesh large = CubesSurface(Block(3, 3, 3), 2);
  const TriangleMesh inside = CubesSurface({{1, 1, 2}}, 2);
  // A ring with a skin of two sides over its hole.
  Cubes around = Block(3, 3, 1);
  around.erase({1, 1, 0});
  const TriangleMesh ring = CubesSurface(around, 2);
  TriangleMesh skin = Grid(2, 2);
  skin.positions /= 2;
  skin.positions.rowwise() += Eigen::RowVector3d(1, 1, 1);
  TriangleMesh below = skin;
  TurnOver(below);
  for (const std::vector<TriangleMesh>& meshes :
       {std::vector{body, hat, lining},
        {body, hat, hat},
        {body, cube, turned},
        {large, inside},
        {ring, skin, below}}) {
    const CanonicalMesh c = CanonicalOf(Together(meshes));
    EXPECT_EQ(c.report.inner_wall_faces, 0u);
    EXPECT_GT(c.report.nonmanifold_edges, 0u);
  }
}

// Of shells that disagree on what is outside, none is known to be inside.
TEST(InnerWallsTest, WallsStayWhereOneShellIsInsideOut) {
  const TriangleMesh body = CubesSurface(Block(2, 2, 2), 3);
  TriangleMesh head = CubesSurface({{0, 0, 2}}, 3);
  TurnOver(head);
  for (const TriangleMesh& other : {head, OtherDiagonals(head)})
    EXPECT_EQ(CanonicalOf(Together({body, other})).report.inner_wall_faces, 0u);
}

}  // namespace
}  // namespace marrow
