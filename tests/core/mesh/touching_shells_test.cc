#include "core/mesh/touching_shells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/mesh/components.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// All faces counting alike.
PartedMesh Part(const TriangleMesh& mesh, double least_share = 0.01) {
  return PartTouchingShells(
      mesh, std::vector<double>(mesh.NumFaces(), 1.0 / mesh.NumFaces()),
      least_share);
}

// Meshes that have their first vertices in one place, each turned about that.
TriangleMesh Fan(const std::vector<TriangleMesh>& meshes) {
  std::vector<TriangleMesh> all;
  for (const TriangleMesh& mesh : meshes) {
    const Eigen::AngleAxisd turn(0.6 * static_cast<double>(all.size()),
                                 Eigen::Vector3d(1, 2, 3).normalized());
    TriangleMesh& turned = all.emplace_back(mesh);
    turned.positions.rowwise() -= mesh.positions.row(0);
    turned.positions *= turn.toRotationMatrix();
  }
  return CanonicalOf(Together(all)).mesh;
}

uint32_t NumComponents(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.NumVertices());
  return JoinCorners(mesh, sets);
}

TriangleMesh WithoutLastFace(TriangleMesh mesh) {
  mesh.faces.pop_back();
  return mesh;
}

void ExpectSamePlaces(const TriangleMesh& mesh, const PartedMesh& parted) {
  ASSERT_EQ(parted.vertices.size(), parted.mesh.NumVertices());
  ASSERT_EQ(parted.mesh.NumFaces(), mesh.NumFaces());
  EXPECT_TRUE(std::is_sorted(parted.vertices.begin(), parted.vertices.end()));
  for (uint32_t v = 0; v < parted.vertices.size(); ++v)
    EXPECT_EQ(parted.mesh.Position(v), mesh.Position(parted.vertices[v]));
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    for (int corner = 0; corner < 3; ++corner)
      EXPECT_EQ(parted.vertices[parted.mesh.faces[f][corner]],
                mesh.faces[f][corner]);
}

TEST(TouchingShellsTest, ClosedShellsArePartedAtAVertex) {
  for (uint32_t copies : {2, 5, 8}) {
    const TriangleMesh mesh =
        Fan(std::vector<TriangleMesh>(copies, Icosphere(1)));
    ASSERT_EQ(NumComponents(mesh), 1u);
    const PartedMesh parted = Part(mesh);
    EXPECT_EQ(parted.mesh.NumVertices(), mesh.NumVertices() + copies - 1);
    EXPECT_EQ(NumComponents(parted.mesh), copies);
    ExpectSamePlaces(mesh, parted);
  }
}

TEST(TouchingShellsTest, WhereTooManyMeetTheyStayTogether) {
  const TriangleMesh mesh = Fan(std::vector<TriangleMesh>(9, Icosphere(1)));
  EXPECT_TRUE(Part(mesh).vertices.empty());
}

// Else two that share the hub alone would be bridged nowhere.
TEST(TouchingShellsTest, WhatMeetsInAHubStaysTogetherEverywhere) {
  TriangleMesh mesh = TouchingGrids();
  const Eigen::RowVector3d hub(1, 2.5, 0.5);
  for (int i = 0; i < 7; ++i) {
    TriangleMesh speck = Tetrahedron();
    const Eigen::RowVector3d tip = speck.positions.row(0);
    speck.positions =
        ((1 + 0.1 * i) * 0.01 * (speck.positions.rowwise() - tip)).rowwise() +
        hub;
    mesh = Together({mesh, speck});
  }
  mesh = CanonicalOf(mesh).mesh;
  const PartedMesh parted = Part(mesh, 0);
  ExpectSamePlaces(mesh, parted);
  EXPECT_EQ(parted.mesh.NumVertices(), mesh.NumVertices() + 9);
  EXPECT_EQ(NumComponents(parted.mesh), 2u);
}

TEST(TouchingShellsTest, SmallShellsStayTogether) {
  const TriangleMesh bead = Icosphere(0);
  const TriangleMesh mesh = Fan({Icosphere(3), bead, bead});
  EXPECT_EQ(NumComponents(Part(mesh, 0).mesh), 3u);
  EXPECT_EQ(NumComponents(Part(mesh, 0.05).mesh), 2u);
}

TEST(TouchingShellsTest, OpenShellsStayTogether) {
  const TriangleMesh closed = Icosphere(1), open = WithoutLastFace(closed);
  EXPECT_TRUE(Part(Fan({open, open, open})).vertices.empty());
  const TriangleMesh mesh = Fan({open, closed, open});
  const PartedMesh parted = Part(mesh);
  ExpectSamePlaces(mesh, parted);
  EXPECT_EQ(parted.mesh.NumVertices(), mesh.NumVertices() + 1);
  EXPECT_EQ(NumComponents(parted.mesh), 2u);
}

TEST(TouchingShellsTest, WhatTouchesNowhereIsLeftAlone) {
  TriangleMesh moved = Icosphere(1);
  moved.positions.rowwise() += Eigen::RowVector3d(3, 0, 0);
  for (const TriangleMesh& mesh :
       {Icosphere(2), Grid(4, 4), Book(4, 3),
        CanonicalOf(Together({Icosphere(1), moved})).mesh})
    EXPECT_TRUE(Part(mesh).vertices.empty());
}

TEST(TouchingShellsTest, BoxesOfDifferentGridsAreOneEach) {
  const TriangleMesh mesh = CanonicalOf(TouchingGrids()).mesh;
  const PartedMesh parted = Part(mesh);
  EXPECT_EQ(NumComponents(mesh), 1u);
  EXPECT_EQ(NumComponents(parted.mesh), 3u);
  EXPECT_EQ(parted.mesh.NumVertices(), mesh.NumVertices() + 2 * 9);
  ExpectSamePlaces(mesh, parted);
}

}  // namespace
}  // namespace marrow
