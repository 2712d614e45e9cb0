#include "core/boundaries/boundary_meter.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/boundaries/calibration.h"
#include "core/operators/laplacian.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// For each face whether it is left, 0, or right, 1, of a plane across x.
std::vector<uint32_t> SidesOf(const TriangleMesh& mesh, double x) {
  std::vector<uint32_t> side;
  for (const auto& [a, b, c] : mesh.faces) {
    const double middle =
        (mesh.Position(a) + mesh.Position(b) + mesh.Position(c)).x() / 3;
    side.push_back(middle > x);
  }
  return side;
}

// The boundary between the faces left and right of a plane across x.
Measures CutAcross(const TriangleMesh& mesh, double x, bool swapped = false) {
  const Adjacency adjacency(mesh);
  const std::vector<double> areas = FaceAreaShares(mesh);
  const Curvature curvature =
      Curvature::Measure(mesh, adjacency, CancelToken()).value();
  std::vector<uint32_t> side = SidesOf(mesh, x);
  for (uint32_t& s : side) s ^= swapped;
  BoundaryMeter meter(mesh, adjacency, areas, curvature);
  return meter.MeasureBoundary(PieceGraph(adjacency, side, areas), {0, 1});
}

TEST(BoundaryMeterTest, MeasuresTheEquatorOfASphere) {
  const Measures equator = CutAcross(Icosphere(5), 0);
  EXPECT_EQ(equator[kConstant], 1);
  // The cut follows the edges, which the equator of this sphere does not.
  const double length = std::sqrt(std::numbers::pi);
  EXPECT_NEAR(equator[kLength], std::log(length), 0.2);
  EXPECT_NEAR(equator[kRelativeLength], equator[kLength] - 0.5 * std::log(0.5),
              0.01);
  EXPECT_NEAR(equator[kLargerArea], std::log(0.5), 0.01);
  // K r^2 is at least 1, that of a cut of the length above.
  for (Measure saddle : {kSaddleNear, kSaddleMiddle, kSaddleWide})
    EXPECT_LT(equator[saddle], 0.001);
  // Half the sphere is 1.57 r broad, less than the strip, and has area 2 pi
  // r^2.
  EXPECT_NEAR(equator[kStripOfSmaller], std::log(0.5), 0.3);
  EXPECT_NEAR(equator[kStripOfLarger], equator[kStripOfSmaller], 0.1);
}

// Along the ends of the neck the surface is a saddle, and beyond it widens.
TEST(BoundaryMeterTest, SeesTheEndOfANeck) {
  const TriangleMesh mesh = Dumbbell(1, 48);
  const Measures neck = CutAcross(mesh, 0.52);
  EXPECT_GT(neck[kSaddleNear], 0.8);
  EXPECT_GT(neck[kStripOfSmaller], neck[kStripOfLarger] + 0.2);
  const Measures ball = CutAcross(mesh, 1.5);
  EXPECT_LT(ball[kSaddleNear], 0.01);
  EXPECT_GT(Strength(neck), 0.9);
  EXPECT_LT(Strength(ball), 0.1);
}

TEST(BoundaryMeterTest, ACutThroughACylinderIsFlatOnBothSides) {
  const Measures middle = CutAcross(Dumbbell(1, 60), 0);
  // As far as the neck reaches.
  EXPECT_NEAR(middle[kStripOfSmaller], middle[kStripOfLarger], 0.1);
  // Neither a saddle nor none: K is 0.
  EXPECT_NEAR(middle[kSaddleNear], 1 / (1 + std::exp(0.1 / 0.15)), 0.1);
}

TEST(BoundaryMeterTest, NeitherOrderNorScaleNorPlaceMatters) {
  const TriangleMesh mesh = Dumbbell(0.7, 36);
  const Measures expected = CutAcross(mesh, 0.3);
  EXPECT_EQ(CutAcross(mesh, 0.3, true), expected);
  const Measures scaled = CutAcross(Scaled(mesh, 1e8), 0.3e8);
  const Measures rotated = CutAcross(Rotated(mesh, {1, 0, 0}, 0.7), 0.3);
  for (uint32_t i = 0; i < kNumMeasures; ++i) {
    EXPECT_NEAR(scaled[i], expected[i], 1e-4);
    EXPECT_NEAR(rotated[i], expected[i], 1e-4);
  }
}

TEST(BoundaryMeterTest, EveryMeasureIsFiniteOnAnyShape) {
  for (const NamedMesh& shape : AllShapes()) {
    const TriangleMesh mesh = CanonicalOf(shape.mesh).mesh;
    const Adjacency adjacency(mesh);
    const std::vector<double> areas = FaceAreaShares(mesh);
    const Curvature curvature =
        Curvature::Measure(mesh, adjacency, CancelToken()).value();
    BoundaryMeter meter(mesh, adjacency, areas, curvature);
    std::vector<uint32_t> pieces;
    for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
      pieces.push_back(f % 7 * 3 / 7);
    if (mesh.NumFaces() < 7) continue;
    const PieceGraph graph(adjacency, pieces, areas);
    for (const auto& [pair, edges] : graph.boundaries()) {
      const Measures measures = meter.MeasureBoundary(graph, pair);
      for (double measure : measures)
        EXPECT_TRUE(std::isfinite(measure)) << shape.name;
      EXPECT_GE(Strength(measures), 0);
      EXPECT_LE(Strength(measures), 1);
    }
  }
}

// The strength of that boundary where the first split is across `first`.
double RankedAcross(const TriangleMesh& mesh, double x, double first) {
  const Adjacency adjacency(mesh);
  const std::vector<double> areas = FaceAreaShares(mesh);
  const Curvature curvature =
      Curvature::Measure(mesh, adjacency, CancelToken()).value();
  PieceGraph graph(adjacency, SidesOf(mesh, x), areas);
  graph.SetFirstSplit(SidesOf(mesh, first), areas);
  return BoundaryMeter(mesh, adjacency, areas, curvature)
      .StrengthBetween(graph, {0, 1});
}

TEST(BoundaryMeterTest, TheFirstSplitRanksWhatTheAutomaticCutKeeps) {
  const TriangleMesh mesh = Dumbbell(1, 48);
  const double strong = Strength(CutAcross(mesh, 0.52));
  ASSERT_GT(strong, kAutomaticSalience);
  const double along = RankedAcross(mesh, 0.52, 0.52);
  const double near = RankedAcross(mesh, 0.52, 0.3);
  const double partly = RankedAcross(mesh, 0.52, -1.5);
  const double within = RankedAcross(mesh, 0.52, -9);
  EXPECT_LT(along, 1);
  EXPECT_GT(along, strong);
  EXPECT_GT(near, strong);
  EXPECT_LE(near, along);
  EXPECT_LT(partly, near);
  EXPECT_GT(partly, within);
  EXPECT_LT(within, strong);
  EXPECT_GT(within, kAutomaticSalience);
  const double weak = Strength(CutAcross(mesh, 1.5));
  ASSERT_LT(weak, kAutomaticSalience);
  EXPECT_NEAR(RankedAcross(mesh, 1.5, 1.5), weak, 1e-6);
}

TEST(StrengthTest, IsHalfWhereTheWeightsSayNothing) {
  EXPECT_EQ(Strength({}), 0.5);
}

}  // namespace
}  // namespace marrow
