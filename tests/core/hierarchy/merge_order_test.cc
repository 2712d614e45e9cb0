#include "core/hierarchy/merge_order.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/boundaries/calibration.h"
#include "core/boundaries/curvature.h"
#include "core/operators/laplacian.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

// Two pairs and a loner: 0-1, 2-3, then both, then 4 never.
MergeOrder Sketch() { return {5, {{0, 1, 0.2}, {2, 3, 0.4}, {0, 2, 0.4}}}; }

TEST(MergeOrderTest, CutsAtAThreshold) {
  EXPECT_THAT(Sketch().CutAt(0), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(Sketch().CutAt(0.2), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(Sketch().CutAt(0.3), ElementsAre(0, 0, 2, 3, 4));
  EXPECT_THAT(Sketch().CutAt(0.5), ElementsAre(0, 0, 0, 0, 4));
}

TEST(MergeOrderTest, CutsIntoAtMostSoManyGroupsOfOneThreshold) {
  EXPECT_THAT(Sketch().CutInto(9), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(Sketch().CutInto(4), ElementsAre(0, 0, 2, 3, 4));
  // Three would tell merges of one salience apart.
  EXPECT_THAT(Sketch().CutInto(3), ElementsAre(0, 0, 0, 0, 4));
  EXPECT_THAT(Sketch().CutInto(1), ElementsAre(0, 0, 0, 0, 4));
}

TEST(MergeOrderTest, SalienceWithinAGroupIsThatOfItsLastMerge) {
  const MergeOrder order = Sketch();
  EXPECT_THAT(order.InnerSalience(order.CutAt(0.3)),
              ElementsAre(0.2, 0, 0, 0, 0));
  EXPECT_THAT(order.InnerSalience(order.CutAt(1)),
              ElementsAre(0.4, 0, 0, 0, 0));
}

// Slices of a mesh across x.
std::vector<uint32_t> Slices(const TriangleMesh& mesh,
                             const std::vector<double>& limits) {
  std::vector<uint32_t> slice;
  for (const auto& [a, b, c] : mesh.faces) {
    const double x =
        (mesh.Position(a) + mesh.Position(b) + mesh.Position(c)).x() / 3;
    slice.push_back(static_cast<uint32_t>(
        std::lower_bound(limits.begin(), limits.end(), x) - limits.begin()));
  }
  return slice;
}

MergeOrder Merged(const TriangleMesh& mesh, const std::vector<uint32_t>& pieces,
                  double end = std::numeric_limits<double>::infinity()) {
  const Adjacency adjacency(mesh);
  const std::vector<double> areas = FaceAreaShares(mesh);
  const CancelToken cancel;
  const Curvature curvature =
      Curvature::Measure(mesh, adjacency, cancel).value();
  BoundaryMeter meter(mesh, adjacency, areas, curvature);
  return MergePieces(PieceGraph(adjacency, pieces, areas), meter, cancel, end)
      .value();
}

TEST(MergePiecesTest, CutsThroughBallsGoFirstAndTheNeckStays) {
  const TriangleMesh mesh = Dumbbell(1, 36);
  const MergeOrder order = Merged(mesh, Slices(mesh, {-2, -1.2, 0.52, 1.2, 2}));
  ASSERT_EQ(order.merges.size(), 5u);
  EXPECT_TRUE(std::ranges::is_sorted(order.merges, {}, &PieceMerge::salience));
  EXPECT_THAT(order.CutInto(2), ElementsAre(0, 0, 0, 3, 3, 3));
  EXPECT_GT(order.merges[4].salience, kAutomaticSalience);
  EXPECT_LT(order.merges[0].salience, 0.5);
}

TEST(MergePiecesTest, EndsWhereItIsTold) {
  const TriangleMesh mesh = Dumbbell(1, 36);
  const std::vector<uint32_t> slices = Slices(mesh, {-2, -1.2, 0.52, 1.2, 2});
  const MergeOrder whole = Merged(mesh, slices);
  const double end = whole.merges[4].salience;
  const MergeOrder order = Merged(mesh, slices, end);
  EXPECT_LT(order.merges.size(), whole.merges.size());
  EXPECT_LT(order.merges.back().salience, end);
  EXPECT_EQ(order.CutAt(end), whole.CutAt(end));
}

// The smaller with the larger, and as easily as it is small.
TEST(MergePiecesTest, ShellsMergeLast) {
  const TriangleMesh mesh = Apart(Icosphere(2), Icosphere(2));
  std::vector<uint32_t> pieces(mesh.NumFaces());
  for (uint32_t f = 0; f < pieces.size(); ++f)
    pieces[f] = 4 * f / static_cast<uint32_t>(pieces.size());
  const MergeOrder order = Merged(mesh, pieces);
  ASSERT_EQ(order.merges.size(), 3u);
  EXPECT_THAT(order.CutInto(2), ElementsAre(0, 0, 2, 2));
  EXPECT_THAT(order.CutInto(1), ElementsAre(0, 0, 0, 0));
  EXPECT_GT(order.merges[2].salience, kLevelSalience[0]);
  EXPECT_LT(order.merges[2].salience, 1);
}

TEST(MergePiecesTest, StopsOnceCancelled) {
  const TriangleMesh mesh = Grid(4, 4);
  const Adjacency adjacency(mesh);
  const std::vector<double> areas = FaceAreaShares(mesh);
  CancelToken cancel;
  const Curvature curvature =
      Curvature::Measure(mesh, adjacency, cancel).value();
  BoundaryMeter meter(mesh, adjacency, areas, curvature);
  cancel.Cancel();
  EXPECT_TRUE(absl::IsCancelled(
      MergePieces(PieceGraph(adjacency, Slices(mesh, {1, 2}), areas), meter,
                  cancel)
          .status()));
}

}  // namespace
}  // namespace marrow
