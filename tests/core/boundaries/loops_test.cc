#include "core/boundaries/loops.h"

#include <numeric>
#include <vector>

#include "core/mesh/rims.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

TEST(LargestLoopShareTest, IsThatOfTheLongestConnectedPart) {
  const TriangleMesh mesh = Grid(6, 2);
  const Adjacency adjacency(mesh);
  // Straight across at x = 1, and one edge of the same length at x = 4.
  std::vector<uint32_t> whole, broken;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const auto [u, v] = adjacency.EdgeVertices(e);
    const double x = mesh.Position(u).x(), y = mesh.Position(u).y();
    if (mesh.Position(v).x() != x) continue;
    if (x == 1) whole.push_back(e);
    if (x == 1 || (x == 4 && std::min(y, mesh.Position(v).y()) == 0))
      broken.push_back(e);
  }
  ASSERT_EQ(whole.size(), 2u);
  ASSERT_EQ(broken.size(), 3u);
  std::vector<uint32_t> no_rims(mesh.NumVertices());
  std::iota(no_rims.begin(), no_rims.end(), 0u);
  const auto share = [&](const std::vector<uint32_t>& rims,
                         const std::vector<uint32_t>& edges) {
    return LargestLoopShare(adjacency, mesh.positions, rims, edges);
  };
  EXPECT_DOUBLE_EQ(share(no_rims, whole), 1);
  EXPECT_DOUBLE_EQ(share(no_rims, broken), 2.0 / 3);
  EXPECT_EQ(share(no_rims, {}), 0);
  EXPECT_DOUBLE_EQ(share(RimOfVertices(adjacency), broken), 1);
}

TEST(LargestLoopShareTest, GoesOnAcrossAShortGap) {
  const TriangleMesh mesh = Grid(6, 2);
  const Adjacency adjacency(mesh);
  // Up to the middle at x = 1, on from there at x = 2, and what lies between.
  std::vector<uint32_t> halves, between;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const auto [u, v] = adjacency.EdgeVertices(e);
    const Eigen::RowVector3d a = mesh.Position(u), b = mesh.Position(v);
    const Eigen::RowVector3d middle = (a + b) / 2;
    if (a.x() == b.x() && (middle.head<2>() == Eigen::RowVector2d(1, 0.5) ||
                           middle.head<2>() == Eigen::RowVector2d(2, 1.5)))
      halves.push_back(e);
    if (middle.head<2>() == Eigen::RowVector2d(1.5, 1)) between.push_back(e);
  }
  ASSERT_EQ(halves.size(), 2u);
  ASSERT_EQ(between.size(), 1u);
  std::vector<uint32_t> no_rims(mesh.NumVertices());
  std::iota(no_rims.begin(), no_rims.end(), 0u);
  const auto share = [&](double longest_gap) {
    return LargestLoopShare(adjacency, mesh.positions, no_rims, halves, between,
                            longest_gap);
  };
  EXPECT_DOUBLE_EQ(share(0.4), 0.5);
  EXPECT_DOUBLE_EQ(share(0.5), 1);
}

}  // namespace
}  // namespace marrow
