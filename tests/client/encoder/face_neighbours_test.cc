#include "client/encoder/face_neighbours.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/client/encoder/shapes.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

std::vector<uint32_t> Identity(const PolygonMesh& mesh) {
  std::vector<uint32_t> sites(mesh.NumVertices());
  std::iota(sites.begin(), sites.end(), 0u);
  return sites;
}

// Two triangles on the edge 1-2, a third that touches them at 3, and a fourth
// apart from them.
PolygonMesh Row() {
  PolygonMesh mesh;
  for (int i = 0; i < 9; ++i) {
    mesh.positions.push_back({static_cast<float>(i), std::sin(1.0f * i), 0});
  }
  mesh.AddFace(Corners3{0, 1, 2});
  mesh.AddFace(Corners3{1, 2, 3});
  mesh.AddFace(Corners3{3, 4, 5});
  mesh.AddFace(Corners3{6, 7, 8});
  return mesh;
}

TEST(FindStandInsTest, ALabelledFaceStandsForItself) {
  const PolygonMesh mesh = Row();
  EXPECT_THAT(FindStandIns(mesh, Identity(mesh), {true, true, true, true}),
              ElementsAre(0, 1, 2, 3));
}

TEST(FindStandInsTest, AnEdgeGoesBeforeAVertexAndThatBeforeDistance) {
  PolygonMesh mesh = Row();
  mesh.AddFace(std::array<uint32_t, 2>{2, 3});  // an edge of face 1
  mesh.AddFace(Corners3{4, 4, 4});              // a vertex of face 2
  mesh.positions.push_back({7, 0, 0.1f});       // nearest to face 3
  mesh.AddFace(std::array<uint32_t, 1>{9});
  EXPECT_THAT(FindStandIns(mesh, Identity(mesh),
                           {true, true, true, true, false, false, false}),
              ElementsAre(0, 1, 2, 3, 1, 2, 3));
}

TEST(FindStandInsTest, VerticesOfOneSiteAreTheSame) {
  PolygonMesh mesh = Row();
  mesh.positions.push_back(mesh.positions[4]);
  mesh.positions.push_back(mesh.positions[5]);
  mesh.AddFace(Corners3{9, 10, 10});
  std::vector<uint32_t> sites = Identity(mesh);
  sites[9] = 4;
  sites[10] = 5;
  EXPECT_EQ(FindStandIns(mesh, sites, {true, true, true, true, false})[4], 2u);
}

TEST(FindStandInsTest, CopesWithoutCornersAndWithoutNumbers) {
  PolygonMesh mesh = Row();
  mesh.AddFace({});
  mesh.positions.push_back({NAN, 0, 0});
  mesh.AddFace(std::array<uint32_t, 1>{9});
  const std::vector<uint32_t> stand_ins = FindStandIns(
      mesh, Identity(mesh), {true, true, true, true, false, false});
  EXPECT_LT(stand_ins[4], 4u);
  EXPECT_LT(stand_ins[5], 4u);
}

}  // namespace
}  // namespace marrow
