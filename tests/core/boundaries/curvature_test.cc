#include "core/boundaries/curvature.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/operators/laplacian.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

constexpr double kPi = std::numbers::pi;

Curvature Measured(const TriangleMesh& mesh) {
  return Curvature::Measure(mesh, Adjacency(mesh), CancelToken()).value();
}

double TotalDefect(const TriangleMesh& mesh) {
  const std::vector<double> defects = AngleDefects(mesh, Adjacency(mesh));
  return std::accumulate(defects.begin(), defects.end(), 0.0);
}

TEST(UnitAreaPositionsTest, HaveAreaOneAtAnyScale) {
  for (double scale : {1.0, 1e-20, 1e20}) {
    TriangleMesh mesh = Scaled(Grid(3, 5), scale);
    mesh.positions = UnitAreaPositions(mesh);
    // A square of the grid has a fifteenth of the area.
    EXPECT_NEAR((mesh.Position(1) - mesh.Position(0)).norm(),
                std::sqrt(1.0 / 15), 1e-12);
  }
}

TEST(AngleDefectsTest, SumToTheEulerCharacteristic) {
  EXPECT_NEAR(TotalDefect(Icosphere(3)), 4 * kPi, 1e-9);
  EXPECT_NEAR(TotalDefect(LimbCross(3)), 4 * kPi, 1e-9);
  EXPECT_NEAR(TotalDefect(Torus(2, 0.7, 30, 15)), 0, 1e-9);
}

TEST(AngleDefectsTest, AreZeroAtBordersAndWhereSheetsMeet) {
  for (const TriangleMesh& mesh : {Disk(6), Grid(4, 4), Book(3, 5)})
    for (double defect : AngleDefects(mesh, Adjacency(mesh)))
      EXPECT_NEAR(defect, 0, 1e-12);
}

TEST(CurvatureTest, OfASphereOfAreaOneIsFourPi) {
  const TriangleMesh mesh = Icosphere(4);
  const Curvature curvature = Measured(mesh);
  // The twelve vertices of five faces show at the narrow width.
  for (const auto& [width, tolerance] :
       {std::pair(0.02, 0.04), std::pair(0.1, 0.01), std::pair(0.3, 0.005)})
    for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
      ASSERT_NEAR(curvature.At(v, width), 4 * kPi, tolerance * 4 * kPi);
}

TEST(CurvatureTest, OfATorusIsPositiveOutsideAndNegativeInside) {
  const TriangleMesh mesh = Torus(2, 0.7, 60, 30);
  const double area = 4 * kPi * kPi * 2 * 0.7;
  const Curvature curvature = Measured(mesh);
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    const double ring = mesh.Position(v).head<2>().norm();
    // K = cos(angle) / (r (R + r cos(angle))), in a unit where the area is 1.
    const double expected = (ring - 2) / 0.7 / (0.7 * ring) * area;
    EXPECT_NEAR(curvature.At(v, 0.01), expected, 0.06 * area / 1.4);
  }
}

TEST(CurvatureTest, SmoothingKeepsTheTotalAndLevelsTheRest) {
  const TriangleMesh mesh = LimbCross(4);
  const Curvature curvature = Measured(mesh);
  const Eigen::VectorXd M = BuildLaplacian(mesh)->M;
  double last_spread = std::numeric_limits<double>::infinity();
  for (double width : {0.005, 0.04, 0.32}) {
    double total = 0, square = 0;
    for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
      total += M[v] * curvature.At(v, width);
      square += M[v] * std::pow(curvature.At(v, width), 2);
    }
    EXPECT_NEAR(total, 4 * kPi, 1e-3);
    EXPECT_LT(square, last_spread);
    last_spread = square;
  }
}

TEST(CurvatureTest, RunsBetweenTheWidthsAndStaysBeyondThem) {
  const Curvature curvature = Measured(LimbCross(3));
  const double least = Curvature::kLeastWidth;
  const double greatest = std::ldexp(least, Curvature::kNumWidths - 1);
  for (uint32_t v : {0u, 7u, 100u}) {
    EXPECT_NEAR(curvature.At(v, 4 * least * std::sqrt(2)),
                0.5 * (curvature.At(v, 4 * least) + curvature.At(v, 8 * least)),
                1e-9);
    EXPECT_EQ(curvature.At(v, 0), curvature.At(v, least));
    EXPECT_EQ(curvature.At(v, 10 * greatest), curvature.At(v, greatest));
  }
}

TEST(CurvatureTest, StopsOnceCancelled) {
  CancelToken cancel;
  cancel.Cancel();
  const TriangleMesh mesh = Icosphere(1);
  EXPECT_TRUE(absl::IsCancelled(
      Curvature::Measure(mesh, Adjacency(mesh), cancel).status()));
}

}  // namespace
}  // namespace marrow
