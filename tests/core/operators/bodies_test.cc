#include "core/operators/bodies.h"

#include <algorithm>
#include <random>
#include <vector>

#include "core/mesh/adjacency.h"
#include "gtest/gtest.h"
#include "tests/testing/cpu_time.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

TriangleMesh MovedTo(TriangleMesh mesh, double x) {
  mesh.positions.col(0).array() += x;
  return mesh;
}

TEST(BodiesTest, OnePieceIsItself) {
  CanonicalMesh mesh = CanonicalOf(Icosphere(2));
  const Bodies bodies = FindBodies(mesh);
  EXPECT_TRUE(bodies.IsWhole());
  EXPECT_EQ(bodies.bodies[0].canonical.get(), &mesh);
  EXPECT_EQ(mesh.report.bodies, 1u);
  EXPECT_EQ(mesh.report.bridges, 0u);
  EXPECT_EQ(PairsOfBody(bodies.bodies[0], 123), 123u);
}

TEST(BodiesTest, NearShellsAreOne) {
  CanonicalMesh mesh =
      CanonicalOf(Together({Icosphere(3), MovedTo(Icosphere(3), 2.01)}));
  const Bodies bodies = FindBodies(mesh);
  EXPECT_TRUE(bodies.IsWhole());
  EXPECT_EQ(mesh.report.bridged_components, 2u);
  EXPECT_GT(mesh.report.bridges, 1u);
  EXPECT_EQ(mesh.report.bridges, bodies.bodies[0].bridges.size());
  // Said twice, it is the same.
  (void)FindBodies(mesh);
  EXPECT_EQ(mesh.report.bridged_components, 2u);
  EXPECT_EQ(mesh.report.bridges, bodies.bodies[0].bridges.size());
}

TEST(BodiesTest, FarShellsAreSeveralTheLargestFirst) {
  CanonicalMesh mesh = CanonicalOf(
      Together({Scaled(Icosphere(2), 0.5), MovedTo(Icosphere(2), 4)}));
  const Bodies bodies = FindBodies(mesh);
  ASSERT_EQ(bodies.bodies.size(), 2u);
  EXPECT_NEAR(bodies.bodies[0].share, 0.8, 1e-9);
  EXPECT_NEAR(bodies.bodies[1].share, 0.2, 1e-9);
  EXPECT_EQ(PairsOfBody(bodies.bodies[0], 200), 160u);
  EXPECT_EQ(PairsOfBody(bodies.bodies[1], 500), 100u);
  EXPECT_EQ(PairsOfBody(bodies.bodies[1], 200), 60u);
  EXPECT_EQ(PairsOfBody(bodies.bodies[1], 10), 10u);
  std::vector<uint32_t> faces = bodies.bodies[0].faces;
  faces.insert(faces.end(), bodies.bodies[1].faces.begin(),
               bodies.bodies[1].faces.end());
  std::sort(faces.begin(), faces.end());
  EXPECT_EQ(faces, bodies.anchors);
}

TEST(BodiesTest, TheSmallIsAttachedToTheNearestFace) {
  const TriangleMesh eye = Scaled(Icosphere(0), 0.05);
  CanonicalMesh mesh = CanonicalOf(
      Together({Icosphere(2), MovedTo(eye, 1.5), MovedTo(eye, -1.5)}));
  const Bodies bodies = FindBodies(mesh);
  ASSERT_EQ(bodies.bodies.size(), 1u);
  EXPECT_FALSE(bodies.IsWhole());
  EXPECT_EQ(mesh.report.attached_components, 2u);
  EXPECT_EQ(mesh.report.attached_faces, 40u);
  EXPECT_EQ(mesh.report.body_vertices, 162u);
  for (uint32_t f = 0; f < mesh.mesh.NumFaces(); ++f) {
    const uint32_t anchor = bodies.anchors[f];
    EXPECT_EQ(bodies.anchors[anchor], anchor);
    const double x = mesh.mesh.Position(mesh.mesh.faces[f][0]).x();
    if (anchor == f) continue;
    EXPECT_GT(x * mesh.mesh.Position(mesh.mesh.faces[anchor][0]).x(), 0.8);
  }
}

// Two halves of a sphere, a hair apart at the equator.
TEST(BodiesTest, SewnVerticesAreThoseOfTheFacesAskedFor) {
  TriangleMesh north = Icosphere(3), south = north;
  const auto keep = [](TriangleMesh& mesh, double side) {
    std::erase_if(mesh.faces, [&](const Triangle& f) {
      return side * (mesh.Position(f[0]).z() + mesh.Position(f[1]).z() +
                     mesh.Position(f[2]).z()) <
             0;
    });
    mesh.positions.col(2).array() += side * 0.01;
  };
  keep(north, 1);
  keep(south, -1);
  CanonicalMesh mesh = CanonicalOf(Together({north, south}));
  ASSERT_EQ(mesh.report.components, 2u);
  const Bodies bodies = FindBodies(mesh);
  ASSERT_EQ(bodies.bodies.size(), 1u);
  const Body& body = bodies.bodies[0];
  ASSERT_FALSE(body.seams.empty());
  EXPECT_TRUE(std::is_sorted(body.seams.begin(), body.seams.end()));
  for (const auto& [kept, other] : body.seams) {
    EXPECT_NEAR((mesh.mesh.Position(kept) - mesh.mesh.Position(other)).norm(),
                0.02, 0.005);
    EXPECT_TRUE(
        std::binary_search(body.vertices.begin(), body.vertices.end(), kept));
    // By the faces of either half.
    const uint32_t own =
        std::lower_bound(body.vertices.begin(), body.vertices.end(), kept) -
        body.vertices.begin();
    for (uint32_t v : {kept, other}) {
      const uint32_t face = Adjacency(mesh.mesh).VertexFaces(v).front();
      EXPECT_EQ(ToWholeVertices(body, mesh.mesh, {own}, {face}),
                std::vector<uint32_t>{v});
    }
  }
}

// A creature of plates: each is a speck, together they are all there is.
TEST(BodiesTest, ManyLightComponentsOfWeightAreBridged) {
  std::vector<TriangleMesh> plates;
  for (int i = 0; i < 400; ++i) {
    plates.push_back(MovedTo(Grid(4, 4), 4.2 * (i % 20)));
    plates.back().positions.col(1).array() += 4.2 * (i / 20);
  }
  CanonicalMesh mesh = CanonicalOf(Together(plates));
  const Bodies bodies = FindBodies(mesh);
  ASSERT_EQ(bodies.bodies.size(), 1u);
  EXPECT_EQ(bodies.bodies[0].faces.size(), mesh.mesh.NumFaces());
  // Grown together at their corners and sides, so that it is not the mesh.
  EXPECT_FALSE(bodies.IsWhole());
  EXPECT_TRUE(bodies.bodies[0].bridges.empty());
  EXPECT_EQ(bodies.bodies[0].seams.size() + bodies.bodies[0].vertices.size(),
            mesh.mesh.NumVertices());
  EXPECT_EQ(mesh.report.bridged_components, 400u);
}

TEST(BodiesTest, ThereAreNeverManyBodies) {
  std::vector<TriangleMesh> debris;
  for (int i = 0; i < 500; ++i) {
    debris.push_back(MovedTo(Icosphere(0), 10 * (i % 10)));
    debris.back().positions.col(1).array() += 10 * (i / 10 % 10);
    debris.back().positions.col(2).array() += 10 * (i / 100);
  }
  CanonicalMesh mesh = CanonicalOf(Together(debris));
  const Bodies bodies = FindBodies(mesh);
  EXPECT_EQ(bodies.bodies.size(), kMaxBodies);
  EXPECT_EQ(mesh.report.attached_components, 500u - kMaxBodies);
}

TEST(BodiesTest, ACrowdOfEqualsHasNoOneLeftOut) {
  std::vector<TriangleMesh> crowd;
  for (int i = 0; i < 100; ++i) crowd.push_back(MovedTo(Icosphere(1), 10 * i));
  CanonicalMesh mesh = CanonicalOf(Rotated(Together(crowd), {1, 2, 3}, 1));
  EXPECT_EQ(FindBodies(mesh).bodies.size(), 100u);
}

// Where they touch, neither has a vertex.
TEST(BodiesTest, LegsOfACrowdAreBridgedAsOfOne) {
  TriangleMesh leg = CubesSurface({{0, 0, 0}}, 1);
  leg.positions *= Eigen::Vector3d(0.2, 0.2, 1).asDiagonal();
  leg.positions.rowwise() += Eigen::RowVector3d(0.4, 0.4, -1);
  const TriangleMesh creature = Together({CubesSurface({{0, 0, 0}}, 1), leg});
  std::vector<TriangleMesh> crowd;
  for (int i = 0; i < 40; ++i) crowd.push_back(MovedTo(creature, 10 * i));
  CanonicalMesh mesh = CanonicalOf(Together(crowd));
  EXPECT_EQ(FindBodies(mesh).bodies.size(), 40u);
}

// A cap on a ball is worn by it, but where it alone reaches another ball.
TEST(BodiesTest, WhatHoldsOthersTogetherIsNotWorn) {
  const TriangleMesh ball = Icosphere(3);
  TriangleMesh cap = Scaled(ball, 1.1);
  std::erase_if(cap.faces, [&](const Triangle& face) {
    return cap.positions(face[0], 0) < -0.5;
  });
  cap = CanonicalOf(cap).mesh;
  CanonicalMesh alone = CanonicalOf(Together({ball, cap}));
  EXPECT_EQ(FindBodies(alone).bodies.size(), 1u);
  EXPECT_EQ(alone.report.worn_components, 1u);
  EXPECT_EQ(alone.report.attached_faces, cap.NumFaces());
  CanonicalMesh held =
      CanonicalOf(Together({ball, cap, MovedTo(Scaled(ball, 0.9), 2.1)}));
  EXPECT_EQ(FindBodies(held).bodies.size(), 1u);
  EXPECT_EQ(held.report.worn_components, 0u);
  EXPECT_EQ(held.report.bridged_components, 3u);
}

TEST(BodiesTest, AnyScaleGivesTheSame) {
  const TriangleMesh mesh = Together({Icosphere(3), MovedTo(Icosphere(3), 2.01),
                                      MovedTo(Scaled(Icosphere(0), 0.01), 4)});
  CanonicalMesh unit = CanonicalOf(mesh);
  const Bodies expected = FindBodies(unit);
  for (double factor : {0x1p-66, 0x1p66}) {
    CanonicalMesh scaled = CanonicalOf(Scaled(mesh, factor));
    const Bodies bodies = FindBodies(scaled);
    EXPECT_EQ(bodies.anchors, expected.anchors);
    EXPECT_EQ(bodies.bodies[0].bridges, expected.bodies[0].bridges);
  }
}

// Dust: one speck is as good as another, and 100,000 cost next to nothing.
TEST(BodiesTest, DustStaysQuick) {
  constexpr uint32_t kCount = 100'000;
  const TriangleMesh speck = Tetrahedron();
  std::mt19937 random(5);
  TriangleMesh dust;
  dust.positions.resize(4 * kCount, 3);
  for (uint32_t i = 0; i < kCount; ++i) {
    Eigen::RowVector3d place;
    for (int axis = 0; axis < 3; ++axis)
      place[axis] = 1000 * (random() * 0x1p-32);
    for (uint32_t v = 0; v < 4; ++v)
      dust.positions.row(4 * i + v) = speck.positions.row(v) + place;
    for (const Triangle& f : speck.faces)
      dust.faces.push_back({4 * i + f[0], 4 * i + f[1], 4 * i + f[2]});
  }
  CanonicalMesh mesh = CanonicalOf(dust);
  const double start = CpuSeconds();
  const Bodies bodies = FindBodies(mesh);
  EXPECT_LT(CpuSeconds() - start, Allowed(3));
  ASSERT_EQ(bodies.bodies.size(), 1u);
  EXPECT_EQ(mesh.report.body_vertices, 4u);
  EXPECT_EQ(mesh.report.attached_components, kCount - 1);
}

}  // namespace
}  // namespace marrow
