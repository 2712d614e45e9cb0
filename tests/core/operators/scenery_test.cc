#include "core/operators/scenery.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/operators/bodies.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// A square in z = -height, of that many squares in each direction.
TriangleMesh Ground(uint32_t squares, double width, double height) {
  TriangleMesh ground = Grid(squares, squares);
  ground.positions *= width / squares;
  ground.positions.rowwise() -=
      Eigen::RowVector3d(width / 2, width / 2, height);
  return ground;
}

TriangleMesh Box(double width) {
  TriangleMesh box = CubesSurface({{0, 0, 0}}, 1);
  box.positions.array() -= 0.5;
  box.positions *= width;
  return box;
}

// A creature among something else: how many bodies there are, and what the
// first has of the area.
void ExpectScenery(const TriangleMesh& creature, const TriangleMesh& other) {
  for (double angle : {0.0, 1.0}) {
    CanonicalMesh mesh =
        CanonicalOf(Rotated(Together({creature, other}), {1, 2, 3}, angle));
    const Bodies bodies = FindBodies(mesh);
    ASSERT_EQ(bodies.bodies.size(), 2u);
    EXPECT_EQ(bodies.bodies[0].faces.size(), creature.NumFaces());
    EXPECT_NEAR(bodies.bodies[0].share, 1 / (1 + kSceneryShare), 1e-12);
    EXPECT_EQ(bodies.bodies[1].faces.size(), other.NumFaces());
  }
}

uint32_t CountScenery(const TriangleMesh& a, const TriangleMesh& b) {
  const TriangleMesh mesh = Together({a, b});
  std::vector<std::vector<uint32_t>> components(2);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    components[f >= a.NumFaces()].push_back(f);
  uint32_t count = 0;
  for (bool is : FindScenery(mesh, components)) count += is;
  return count;
}

TEST(SceneryTest, GroundBoxAndDomeAreNotTheCreature) {
  const TriangleMesh creature = Icosphere(4);
  ExpectScenery(creature, Ground(1, 5, 1.001));
  ExpectScenery(creature, Ground(1, 1000, 3));
  ExpectScenery(creature, Ground(40, 5, 1.001));
  ExpectScenery(creature, Box(5));
  ExpectScenery(creature, Scaled(Icosphere(3), 4));
}

TEST(SceneryTest, WhatIsPartOfACreatureIsNone) {
  // A plain body under much hair or with fine eyes, a star with a speck, a
  // sphere in a sphere, a giant beside a dwarf.
  TriangleMesh eye = Scaled(Icosphere(4), 0.1);
  eye.positions.col(0).array() += 0.95;
  EXPECT_EQ(CountScenery(Icosphere(3), eye), 0u);
  EXPECT_EQ(CountScenery(Ground(40, 10, 0), Scaled(Icosphere(0), 0.1)), 0u);
  EXPECT_EQ(CountScenery(Icosphere(3), Scaled(Icosphere(3), 0.3)), 0u);
  TriangleMesh giant = Scaled(Icosphere(2), 4);
  giant.positions.col(0).array() += 8;
  EXPECT_EQ(CountScenery(giant, Icosphere(4)), 0u);
}

TEST(SceneryTest, MayBeSeveral) {
  CanonicalMesh mesh = CanonicalOf(
      Together({Icosphere(4), Ground(1, 5, 1.001), Scaled(Icosphere(3), 8)}));
  const Bodies bodies = FindBodies(mesh);
  ASSERT_EQ(bodies.bodies.size(), 3u);
  EXPECT_EQ(bodies.bodies[0].faces.size(), Icosphere(4).NumFaces());
  EXPECT_NEAR(bodies.bodies[0].share, 1 / (1 + 2 * kSceneryShare), 1e-12);
}

TEST(SceneryTest, OfACrowdCountsAsOfOne) {
  const TriangleMesh creature = Icosphere(2);
  std::vector<TriangleMesh> crowd = {Ground(1, 1000, 1.001)};
  for (int i = 0; i < 20; ++i) {
    crowd.push_back(creature);
    crowd.back().positions.col(0).array() += 10 * i;
  }
  CanonicalMesh mesh = CanonicalOf(Together(crowd));
  const Bodies bodies = FindBodies(mesh);
  ASSERT_EQ(bodies.bodies.size(), 21u);
  EXPECT_NEAR(bodies.bodies[20].share, kSceneryShare * bodies.bodies[0].share,
              1e-12);
}

TEST(SceneryTest, NothingIsAttachedToIt) {
  TriangleMesh nail = Scaled(Icosphere(0), 0.01);
  nail.positions.col(2).array() -= 0.999;
  nail.positions.col(0).array() += 0.3;
  const TriangleMesh creature = Icosphere(4);
  CanonicalMesh mesh =
      CanonicalOf(Together({creature, Ground(1, 5, 1.001), nail}));
  const Bodies bodies = FindBodies(mesh);
  ASSERT_EQ(bodies.bodies.size(), 2u);
  EXPECT_EQ(mesh.report.attached_components, 1u);
  const std::vector<uint32_t>& own = bodies.bodies[0].faces;
  for (uint32_t f = 0; f < bodies.anchors.size(); ++f)
    if (bodies.anchors[f] != f) {
      EXPECT_TRUE(
          std::binary_search(own.begin(), own.end(), bodies.anchors[f]));
    }
}

TEST(SceneryTest, OfWhatHasNoAreaThereIsNone) {
  TriangleMesh line = SingleTriangle();
  line.positions << 0, 0, 1, 0.1, 0, 1, 0.2, 0, 1;
  CanonicalMesh mesh = CanonicalOf(Together({Ground(1, 5, 0), line}));
  const Bodies bodies = FindBodies(mesh);
  ASSERT_EQ(bodies.bodies.size(), 1u);
  EXPECT_EQ(bodies.bodies[0].faces.size(), 2u);
  EXPECT_EQ(bodies.bodies[0].share, 1);
  EXPECT_EQ(mesh.report.attached_components, 1u);
}

TEST(SceneryTest, OfOneComponentThereIsNone) {
  const TriangleMesh mesh = Ground(1, 5, 0);
  EXPECT_EQ(FindScenery(mesh, {{0, 1}}), std::vector<bool>{false});
  EXPECT_EQ(FindScenery(mesh, {{0}, {1}}), (std::vector<bool>{false, false}));
}

}  // namespace
}  // namespace marrow
