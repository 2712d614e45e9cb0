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

}  // namespace
}  // namespace marrow
