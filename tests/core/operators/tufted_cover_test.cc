#include "core/operators/tufted_cover.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/base/disjoint_sets.h"
#include "gtest/gtest.h"
#include "tests/core/operators/hostile_shapes.h"

namespace marrow {
namespace {

uint32_t EndOf(const GluedTriangles& glued, uint32_t side) {
  return glued.corners[side % 3 == 2 ? side - 2 : side + 1];
}

void ExpectClosedAndOriented(const GluedTriangles& glued,
                             const Adjacency& adjacency) {
  std::vector<int> uses(glued.corners.size(), 0);
  ASSERT_EQ(glued.edges.size(), glued.mesh_edge.size());
  for (size_t e = 0; e < glued.edges.size(); ++e) {
    const auto [s, t] = glued.edges[e];
    ++uses[s];
    ++uses[t];
    EXPECT_EQ(glued.corners[s], EndOf(glued, t));
    EXPECT_EQ(glued.corners[t], EndOf(glued, s));
    const auto ends = adjacency.EdgeVertices(glued.mesh_edge[e]);
    EXPECT_EQ(std::min(glued.corners[s], glued.corners[t]), ends[0]);
    EXPECT_EQ(std::max(glued.corners[s], glued.corners[t]), ends[1]);
  }
  EXPECT_TRUE(std::all_of(uses.begin(), uses.end(),
                          [](int times) { return times == 1; }));
}

// How many surfaces the triangles form.
uint32_t Surfaces(const GluedTriangles& glued) {
  uint32_t surfaces = static_cast<uint32_t>(glued.corners.size() / 3);
  DisjointSets sets(surfaces);
  for (const auto& [s, t] : glued.edges) surfaces -= sets.Union(s / 3, t / 3);
  return surfaces;
}

TEST(TuftedCoverTest, ClosesAnyMesh) {
  for (const auto& [name, mesh] : HostileShapes()) {
    SCOPED_TRACE(name);
    const Adjacency adjacency(mesh);
    const GluedTriangles cover = GlueTuftedCover(mesh, adjacency);
    EXPECT_EQ(cover.corners.size(), 6 * mesh.faces.size());
    EXPECT_EQ(cover.sheets, 2u);
    ExpectClosedAndOriented(cover, adjacency);
  }
}

TEST(TuftedCoverTest, HasTwoSidesWhereTheMeshHasTwo) {
  const auto surfaces = [](const TriangleMesh& mesh) {
    return Surfaces(GlueTuftedCover(mesh, Adjacency(mesh)));
  };
  EXPECT_EQ(surfaces(Icosphere(1)), 2u);
  EXPECT_EQ(surfaces(TurnedOver(Icosphere(1))), 2u);
  EXPECT_EQ(surfaces(Disk(3)), 1u);
  EXPECT_EQ(surfaces(Moebius(12)), 1u);
  EXPECT_EQ(surfaces(KleinBottle(12, 8)), 1u);
  EXPECT_EQ(surfaces(TurnedOver(KleinBottle(12, 8))), 1u);
}

TEST(TuftedCoverTest, GluesNeighboursAboutAnEdge) {
  // Pages are at angles 0, 1/5, ... of a turn, but their order is 0 3 1 4 2.
  TriangleMesh mesh = Pages(5);
  const Positions original = mesh.positions;
  for (int page = 0; page < 5; ++page)
    mesh.positions.row(2 + page) = original.row(2 + 3 * page % 5);
  const Adjacency adjacency(mesh);
  const GluedTriangles cover = GlueTuftedCover(mesh, adjacency);
  std::set<std::array<uint32_t, 2>> pairs;
  for (size_t e = 0; e < cover.edges.size(); ++e) {
    const auto [s, t] = cover.edges[e];
    if (adjacency.EdgeFaces(cover.mesh_edge[e]).size() < 3) continue;
    pairs.insert(std::minmax({3 * (s / 6) % 5, 3 * (t / 6) % 5}) ==
                         std::minmax({0u, 4u})
                     ? std::array<uint32_t, 2>{4, 0}
                     : std::array<uint32_t, 2>{
                           std::min(3 * (s / 6) % 5, 3 * (t / 6) % 5),
                           std::max(3 * (s / 6) % 5, 3 * (t / 6) % 5)});
  }
  const std::set<std::array<uint32_t, 2>> expected = {
      {0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}};
  EXPECT_EQ(pairs, expected);
}

TEST(TuftedCoverTest, KnowsWhatNeedsNoCover) {
  const auto needs_none = [](const TriangleMesh& mesh) {
    return IsClosedAndOriented(mesh, Adjacency(mesh));
  };
  EXPECT_TRUE(needs_none(Icosphere(1)));
  EXPECT_TRUE(needs_none(Torus(2, 0.7, 9, 7)));
  EXPECT_FALSE(needs_none(TurnedOver(Icosphere(1))));
  EXPECT_FALSE(needs_none(KleinBottle(12, 8)));
  EXPECT_FALSE(needs_none(Disk(3)));
  EXPECT_FALSE(needs_none(Pages(3)));
  const TriangleMesh torus = Torus(2, 0.7, 9, 7);
  const Adjacency adjacency(torus);
  const GluedTriangles glued = GlueFaces(torus, adjacency);
  EXPECT_EQ(glued.corners.size(), 3 * torus.faces.size());
  EXPECT_EQ(glued.sheets, 1u);
  ExpectClosedAndOriented(glued, adjacency);
}

}  // namespace
}  // namespace marrow
