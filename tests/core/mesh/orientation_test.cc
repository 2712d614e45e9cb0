#include "core/mesh/orientation.h"

#include <utility>

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
  TriangleMesh strip;
  constexpr uint32_t kLength = 9;
  strip.positions.setRandom(2 * kLength, 3);
  for (uint32_t i = 0; i < kLength; ++i) {
    const bool last = i + 1 == kLength;
    const uint32_t a = 2 * i, b = a + 1;
    const uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.faces.push_back({a, c, b});
    strip.faces.push_back({b, c, d});
  }
  EXPECT_FALSE(Check(strip).orientable);
  EXPECT_EQ(Check(strip).flipped_faces, 0u);
  TriangleMesh both = Apart(strip, Icosphere(1));
  Flip(both.faces.back());
  EXPECT_FALSE(Check(both).orientable);
  EXPECT_EQ(Check(both).flipped_faces, 1u);
}

// Nothing is asked of an edge where three faces meet.
TEST(OrientationTest, NonManifoldEdgesPart) {
  TriangleMesh mesh = Book(3, 1);
  for (Triangle& face : mesh.faces) face = {face[1], face[2], face[0]};
  EXPECT_TRUE(Check(mesh).orientable);
}

}  // namespace
}  // namespace marrow
