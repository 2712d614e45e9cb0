#include "core/boundaries/noise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/operators/laplacian.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

double MeanEdge(const TriangleMesh& mesh, const Adjacency& adjacency) {
  double sum = 0;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const auto [a, b] = adjacency.EdgeVertices(e);
    sum += (mesh.Position(a) - mesh.Position(b)).norm();
  }
  return sum / adjacency.NumEdges();
}

// A value from -1.7 to 1.7 of deviation 1, another for every vertex.
double Scatter(uint32_t v) {
  return std::sqrt(12.0) * (std::fmod(v * 0.7548776662466927, 1.0) - 0.5);
}

// A ball of radius 1 whose vertices are moved in and out by `share` of the mean
// edge.
TriangleMesh RoughBall(double share) {
  TriangleMesh mesh = Icosphere(4);
  const double edge = MeanEdge(mesh, Adjacency(mesh));
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
    mesh.positions.row(v) *= 1 + share * edge * Scatter(v);
  return mesh;
}

// The deviation of the vertices' radii, as a share of their mean.
double Roughness(const TriangleMesh& mesh) {
  const Eigen::ArrayXd radii = mesh.positions.rowwise().norm();
  return std::sqrt((radii / radii.mean() - 1).square().mean());
}

TEST(BumpAgreementTest, IsHighOnShapesAndLowWithNoise) {
  for (const TriangleMesh& mesh :
       {Icosphere(3), Torus(2, 0.7, 30, 15), LimbCross(3), Dumbbell(1, 24)})
    EXPECT_GT(BumpAgreement(mesh, Adjacency(mesh)), 0.3);
  for (double share : {0.2, 0.5, 1.0}) {
    const TriangleMesh rough = RoughBall(share);
    EXPECT_LT(BumpAgreement(rough, Adjacency(rough)), 0.1) << share;
  }
}

TEST(BumpAgreementTest, IsOneOnAPlane) {
  const TriangleMesh plane = Grid(5, 4);
  EXPECT_EQ(BumpAgreement(plane, Adjacency(plane)), 1);
  // Where its bumps are rounding.
  const TriangleMesh turned = Rotated(plane, {1, 2, 3}, 1);
  EXPECT_EQ(BumpAgreement(turned, Adjacency(turned)), 1);
}

TEST(BumpAgreementTest, NeitherScaleNorTurnMatters) {
  const TriangleMesh rough = RoughBall(0.5);
  const Adjacency adjacency(rough);
  const double expected = BumpAgreement(rough, adjacency);
  EXPECT_NEAR(BumpAgreement(Scaled(rough, 1e9), adjacency), expected, 1e-9);
  EXPECT_NEAR(BumpAgreement(Rotated(rough, {1, 2, 0}, 1), adjacency), expected,
              1e-9);
}

// Shells that were sewn may look opposite ways.
TEST(BumpAgreementTest, TurnedFacesDoNotMatter) {
  for (const TriangleMesh& mesh :
       {Icosphere(3), RoughBall(0.5), Apart(LimbCross(3), Disk(6))}) {
    const Adjacency adjacency(mesh);
    for (uint32_t step : {1u, 2u, 3u}) {
      TriangleMesh flipped = mesh;
      for (uint32_t f = 0; f < mesh.NumFaces(); f += step)
        std::swap(flipped.faces[f][1], flipped.faces[f][2]);
      EXPECT_NEAR(BumpAgreement(flipped, Adjacency(flipped)),
                  BumpAgreement(mesh, adjacency), 1e-12);
    }
  }
}

TEST(WithoutNoiseTest, LeavesShapesAlone) {
  for (const TriangleMesh& mesh : {Icosphere(3), LimbCross(3), Grid(5, 4)})
    EXPECT_EQ(WithoutNoise(mesh, Adjacency(mesh)).positions, mesh.positions);
}

TEST(WithoutNoiseTest, TakesNoiseAway) {
  for (double share : {0.2, 0.5}) {
    const TriangleMesh rough = RoughBall(share);
    const TriangleMesh calm = WithoutNoise(rough, Adjacency(rough));
    EXPECT_EQ(calm.faces, rough.faces);
    EXPECT_LT(Roughness(calm), 0.4 * Roughness(rough)) << share;
  }
}

TEST(WithoutNoiseTest, LeavesSomeAreaOnAnyShape) {
  for (const NamedMesh& shape : AllShapes()) {
    const TriangleMesh mesh = CanonicalOf(shape.mesh).mesh;
    const TriangleMesh calm = WithoutNoise(mesh, Adjacency(mesh));
    EXPECT_TRUE(calm.positions.allFinite()) << shape.name;
    double area = 0;
    for (double share : FaceAreaShares(calm)) area += share;
    EXPECT_NEAR(area, 1, 1e-9) << shape.name;
  }
}

}  // namespace
}  // namespace marrow
