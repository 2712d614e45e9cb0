#include "core/operators/intrinsic_triangulation.h"

#include <cmath>
#include <utility>

#include "gtest/gtest.h"
#include "tests/core/operators/hostile_shapes.h"

namespace marrow {
namespace {

using Real = IntrinsicTriangulation::Real;

std::vector<Real> LengthsOf(const TriangleMesh& mesh,
                            const Adjacency& adjacency) {
  std::vector<Real> lengths;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const auto [u, v] = adjacency.EdgeVertices(e);
    lengths.push_back((mesh.Position(u) - mesh.Position(v)).norm());
  }
  return lengths;
}

IntrinsicTriangulation CoverOf(const TriangleMesh& mesh) {
  const Adjacency adjacency(mesh);
  return {GlueTuftedCover(mesh, adjacency), LengthsOf(mesh, adjacency)};
}

double AreaOf(const IntrinsicTriangulation& triangulation, uint32_t vertices) {
  return triangulation.VertexAreas(vertices).sum();
}

uint64_t Flip(IntrinsicTriangulation& triangulation) {
  const auto flips = triangulation.FlipToDelaunay(1'000'000, CancelToken());
  EXPECT_TRUE(flips.ok()) << flips.status();
  return flips.value_or(0);
}

// Corners (+-2, 0) and (0, +-1) with the long diagonal.
TriangleMesh Rhombus() {
  TriangleMesh mesh = Grid(1, 1);
  mesh.positions << -2, 0, 0, 0, 1, 0, 0, -1, 0, 2, 0, 0;
  return mesh;
}

TEST(IntrinsicTriangulationTest, FlipsToTheShortDiagonal) {
  IntrinsicTriangulation triangulation = CoverOf(Rhombus());
  // Once on either side.
  EXPECT_EQ(Flip(triangulation), 2u);
  double diagonal = 0;
  for (const auto& [ends, weight] : triangulation.WeightedEdges()) {
    EXPECT_FALSE(std::minmax(ends[0], ends[1]) == std::minmax(0u, 3u));
    if (std::min(ends[0], ends[1]) == 1 && std::max(ends[0], ends[1]) == 2)
      diagonal += weight;
  }
  // Half of twice the cotangent of an angle between sides (2, 1), (2, -1).
  EXPECT_NEAR(diagonal, 2 * 0.75, 1e-14);
  EXPECT_NEAR(AreaOf(triangulation, 4), 8, 1e-14);
  EXPECT_EQ(Flip(triangulation), 0u);
}

TEST(IntrinsicTriangulationTest, KeepsTheAreaAndTheWeightsPositive) {
  for (const auto& [name, mesh] : HostileShapes()) {
    SCOPED_TRACE(name);
    IntrinsicTriangulation triangulation = CoverOf(mesh);
    triangulation.Mollify(1e-6L);
    const double area = AreaOf(triangulation, mesh.NumVertices());
    Flip(triangulation);
    EXPECT_NEAR(AreaOf(triangulation, mesh.NumVertices()), area, 1e-9 * area);
    for (const auto& [ends, weight] : triangulation.WeightedEdges()) {
      EXPECT_GE(weight, 0);
      EXPECT_TRUE(std::isfinite(weight));
    }
    EXPECT_EQ(Flip(triangulation), 0u);
  }
}

TEST(IntrinsicTriangulationTest, MollifiesNoMoreThanItMust) {
  // Sides 3, 4 and 5 leave 2; those of a triangle on a line leave nothing.
  TriangleMesh mesh = SingleTriangle();
  mesh.positions << 0, 0, 0, 3, 0, 0, 0, 4, 0;
  EXPECT_EQ(CoverOf(mesh).Mollify(2), 0);
  EXPECT_EQ(CoverOf(mesh).Mollify(2.5L), 0.5L);
  mesh.positions(2, 1) = 0;
  mesh.positions(2, 0) = 1;
  IntrinsicTriangulation flat = CoverOf(mesh);
  EXPECT_EQ(AreaOf(flat, 3), 0);
  EXPECT_EQ(flat.Mollify(0.25L), 0.25L);
  EXPECT_GT(AreaOf(flat, 3), 0);
}

TEST(IntrinsicTriangulationTest, StopsAtTheBoundAndWhenCancelled) {
  IntrinsicTriangulation triangulation = CoverOf(RandomObtuse(200, true, 1));
  CancelToken cancel;
  EXPECT_EQ(triangulation.FlipToDelaunay(5, cancel).status().code(),
            absl::StatusCode::kResourceExhausted);
  cancel.Cancel();
  EXPECT_EQ(triangulation.FlipToDelaunay(1'000'000, cancel).status().code(),
            absl::StatusCode::kCancelled);
  EXPECT_GT(Flip(triangulation), 0u);
}

}  // namespace
}  // namespace marrow
