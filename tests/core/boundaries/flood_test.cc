#include "core/boundaries/flood.h"

#include <set>
#include <vector>

#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// The edges of a grid at x = 0.
std::vector<uint32_t> LeftEdge(const TriangleMesh& mesh,
                               const Adjacency& adjacency) {
  std::vector<uint32_t> edges;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const auto [u, v] = adjacency.EdgeVertices(e);
    if (mesh.Position(u).x() == 0 && mesh.Position(v).x() == 0)
      edges.push_back(e);
  }
  return edges;
}

TEST(FloodTest, FindsAllFacesNearTheEdgesAndNoOther) {
  const TriangleMesh mesh = Grid(10, 3);
  const Adjacency adjacency(mesh);
  Flood flood(mesh, adjacency, mesh.positions);
  for (double limit : {2.5, 0.5, 4.5}) {
    flood.Run(LeftEdge(mesh, adjacency), limit, [](uint32_t) { return true; });
    const std::set<uint32_t> reached(flood.faces().begin(),
                                     flood.faces().end());
    EXPECT_EQ(reached.size(), flood.faces().size());
    EXPECT_EQ(flood.farthest(), limit);
    for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
      double nearest = 10, mean = 0;
      for (uint32_t v : mesh.faces[f]) {
        nearest = std::min(nearest, mesh.Position(v).x());
        mean += mesh.Position(v).x() / 3;
      }
      EXPECT_EQ(reached.contains(f), nearest < limit);
      if (reached.contains(f)) {
        EXPECT_NEAR(flood.DistanceOf(f), mean, 1e-12);
      }
    }
  }
}

TEST(FloodTest, SharesOutTheFacesThatALimitRunsThrough) {
  const TriangleMesh mesh = Grid(10, 3);
  const Adjacency adjacency(mesh);
  Flood flood(mesh, adjacency, mesh.positions);
  flood.Run(LeftEdge(mesh, adjacency), 5, [](uint32_t) { return true; });
  double last = 0;
  for (double distance : {0.0, 1.0, 2.25, 2.5, 2.75, 3.0, 5.0}) {
    double area = 0;
    for (uint32_t f : flood.faces())
      area += 0.5 * flood.ShareWithin(f, distance);
    EXPECT_NEAR(area, 3 * distance, 0.6);
    EXPECT_GE(area, last);
    last = area;
  }
}

TEST(FloodTest, StaysWithin) {
  const TriangleMesh mesh = Grid(10, 3);
  const Adjacency adjacency(mesh);
  auto within = [&](uint32_t f) {
    for (uint32_t v : mesh.faces[f])
      if (mesh.Position(v).x() > 4) return false;
    return true;
  };
  Flood flood(mesh, adjacency, mesh.positions);
  flood.Run(LeftEdge(mesh, adjacency), 100, within);
  EXPECT_EQ(flood.faces().size(), 24u);
  EXPECT_EQ(flood.farthest(), 4);
}

}  // namespace
}  // namespace marrow
