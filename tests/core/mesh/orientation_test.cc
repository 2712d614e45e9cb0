#include "core/mesh/orientation.h"

#include <utility>
#include <vector>

#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

Orientation Check(const TriangleMesh& mesh) {
  return CheckOrientation(mesh, Adjacency(mesh));
}

void Flip(Triangle& face) { std::swap(face[1], face[2]); }

TEST(OrientationTest, CleanMeshesAgree) {
  for (const TriangleMesh& mesh : {Icosphere(2), Torus(2, 0.5, 20, 10), Disk(4),
                                   Apart(Tetrahedron(), Disk(2))}) {
    EXPECT_EQ(Check(mesh).flipped_faces, 0u);
    EXPECT_TRUE(Check(mesh).orientable);
  }
}

TEST(OrientationTest, CountsTheFewerOfEveryComponent) {
  TriangleMesh mesh = Apart(Icosphere(1), Icosphere(1));
  for (uint32_t f : {0u, 7u, 8u}) Flip(mesh.faces[f]);
  // All but two of the other: turning those two is less work.
  for (uint32_t f = 82; f < 160; ++f) Flip(mesh.faces[f]);
  EXPECT_EQ(Check(mesh).flipped_faces, 5u);
  EXPECT_TRUE(Check(mesh).orientable);
}

TEST(OrientationTest, AMoebiusStripHasNone) {
  const TriangleMesh strip = Moebius(9);
  EXPECT_FALSE(Check(strip).orientable);
  EXPECT_EQ(Check(strip).flipped_faces, 0u);
  TriangleMesh both = Apart(strip, Icosphere(1));
  Flip(both.faces.back());
  EXPECT_FALSE(Check(both).orientable);
  EXPECT_EQ(Check(both).flipped_faces, 1u);
}

void TurnOver(const std::vector<bool>& turned, TriangleMesh& mesh) {
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (turned[f]) Flip(mesh.faces[f]);
}

TEST(FindSidesTest, TurnsTheFewerOfEveryPart) {
  TriangleMesh mesh = Apart(Icosphere(1), Icosphere(1));
  for (uint32_t f = 0; f < 80; f += 3) Flip(mesh.faces[f]);
  for (uint32_t f = 80; f < 160; ++f)
    if (f % 3 != 0) Flip(mesh.faces[f]);
  const Sides sides = FindSides(mesh, Adjacency(mesh));
  ASSERT_EQ(sides.NumParts(), 2u);
  for (uint32_t f = 0; f < 160; ++f) {
    EXPECT_EQ(sides.part[f], f / 80);
    EXPECT_EQ(sides.is_turned[f], f % 3 == 0);
  }
}

TEST(FindSidesTest, OfEquallyManyTheLeastFaceStays) {
  for (const uint32_t first : {0u, 1u}) {
    TriangleMesh mesh = Icosphere(1);
    for (uint32_t f = first; f < 80; f += 2) Flip(mesh.faces[f]);
    const Sides sides = FindSides(mesh, Adjacency(mesh));
    for (uint32_t f = 0; f < 80; ++f) EXPECT_EQ(sides.is_turned[f], f % 2 == 1);
  }
}

TEST(FacesInwardTest, TurnsEveryPartOutwards) {
  const TriangleMesh expected =
      Apart(Icosphere(1), Apart(LimbCross(2), Torus(2, 0.5, 12, 8)));
  TriangleMesh mesh = expected;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (f % 7 < 4) Flip(mesh.faces[f]);
  // The second time there is nothing to do.
  for (int i = 0; i < 2; ++i) {
    TurnOver(FacesInward(mesh, FindSides(mesh, Adjacency(mesh))), mesh);
    EXPECT_EQ(mesh.faces, expected.faces);
  }
}

TEST(FacesInwardTest, NeitherOverflowsNorVanishes) {
  TriangleMesh mesh = Icosphere(1);
  for (Triangle& face : mesh.faces) Flip(face);
  for (double factor : {0x1p-400, 0x1p400}) {
    const TriangleMesh scaled = Scaled(mesh, factor);
    EXPECT_EQ(FacesInward(scaled, FindSides(scaled, Adjacency(scaled))),
              std::vector<bool>(80, true));
  }
}

// Nothing is asked of an edge where three faces meet.
TEST(OrientationTest, NonManifoldEdgesPart) {
  TriangleMesh mesh = Book(3, 1);
  for (Triangle& face : mesh.faces) face = {face[1], face[2], face[0]};
  EXPECT_TRUE(Check(mesh).orientable);
}

}  // namespace
}  // namespace marrow
