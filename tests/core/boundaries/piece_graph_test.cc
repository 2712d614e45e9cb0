#include "core/boundaries/piece_graph.h"

#include <iterator>
#include <map>
#include <set>
#include <vector>

#include "core/operators/bridges.h"
#include "core/operators/laplacian.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

std::vector<uint32_t> PiecesByX(const TriangleMesh& mesh, double width) {
  std::vector<uint32_t> pieces;
  const double low = mesh.positions.col(0).minCoeff();
  for (const auto& [a, b, c] : mesh.faces)
    pieces.push_back(static_cast<uint32_t>(
        ((mesh.Position(a) + mesh.Position(b) + mesh.Position(c)).x() / 3 -
         low) /
        width));
  return pieces;
}

std::map<PieceGraph::Pair, PieceGraph::Boundary> ByHand(
    const Adjacency& adjacency, const std::vector<uint32_t>& group) {
  std::map<PieceGraph::Pair, PieceGraph::Boundary> result;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    std::set<uint32_t> groups;
    for (uint32_t f : adjacency.EdgeFaces(e)) groups.insert(group[f]);
    for (uint32_t a : groups)
      for (uint32_t b : groups)
        if (a < b) result[{a, b}].push_back(e);
  }
  return result;
}

TEST(PieceGraphTest, NeighboursAreThoseThatShareEdges) {
  const TriangleMesh mesh = Grid(4, 3);
  const Adjacency adjacency(mesh);
  const PieceGraph graph(adjacency, PiecesByX(mesh, 1), FaceAreaShares(mesh));
  EXPECT_EQ(graph.NumPieces(), 4u);
  ASSERT_EQ(graph.boundaries().size(), 3u);
  for (const auto& [pair, edges] : graph.boundaries()) {
    EXPECT_EQ(pair.second, pair.first + 1);
    EXPECT_EQ(edges.size(), 3u);
  }
  EXPECT_NEAR(graph.Area(2), 0.25, 1e-12);
}

// Pages that meet at a spine are all neighbours, and once merged share each
// edge of it once with the third.
TEST(PieceGraphTest, AnEdgeOfManyFacesIsInEveryBoundaryOnce) {
  const TriangleMesh mesh = Book(3, 4);
  const Adjacency adjacency(mesh);
  std::vector<uint32_t> page(mesh.NumFaces());
  for (uint32_t f = 0; f < page.size(); ++f) page[f] = f * 3 / page.size();
  const auto expected = ByHand(adjacency, page);
  PieceGraph graph(adjacency, page, FaceAreaShares(mesh));
  EXPECT_EQ(graph.boundaries(), expected);
  graph.Merge(0, 1);
  for (uint32_t& p : page) p = p == 1 ? 0 : p;
  EXPECT_EQ(graph.boundaries(), ByHand(adjacency, page));
}

TEST(PieceGraphTest, MergingGivesWhatIsSeenFromTheFaces) {
  const TriangleMesh mesh = LimbCross(3);
  const Adjacency adjacency(mesh);
  PieceGraph graph(adjacency, PiecesByX(mesh, 0.9), FaceAreaShares(mesh));
  for (uint32_t left = graph.NumPieces(); left > 1; --left) {
    // Not always the first, so that groups of several pieces meet.
    auto it = graph.boundaries().begin();
    std::advance(it, left % graph.boundaries().size());
    const PieceGraph::Pair pair = it->first;
    graph.Merge(pair.first, pair.second);
    EXPECT_EQ(graph.boundaries(), ByHand(adjacency, graph.group_of_face()));
    EXPECT_EQ(graph.Area(pair.second), 0);
  }
  EXPECT_THAT(std::set<uint32_t>(graph.group_of_face().begin(),
                                 graph.group_of_face().end()),
              ElementsAre(0));
  EXPECT_NEAR(graph.Area(0), 1, 1e-12);
}

// Six pieces of equal area, of which the first three are one segment of the
// first split, and half of the fourth.
TEST(PieceGraphTest, GroupsAreApartByWhatSegmentsTheyAreOf) {
  const TriangleMesh mesh = Grid(6, 2);
  const Adjacency adjacency(mesh);
  const std::vector<uint32_t> piece = PiecesByX(mesh, 1);
  std::vector<uint32_t> segment;
  for (uint32_t f = 0; f < piece.size(); ++f)
    segment.push_back(piece[f] < 3 || (piece[f] == 3 && f % 2 == 0));
  const std::vector<double> areas = FaceAreaShares(mesh);
  PieceGraph graph(adjacency, piece, areas);
  EXPECT_EQ(graph.ApartInFirstSplit({0, 5}), 0);
  graph.SetFirstSplit(segment, areas);
  EXPECT_NEAR(graph.ApartInFirstSplit({0, 1}), 0, 1e-12);
  EXPECT_NEAR(graph.ApartInFirstSplit({2, 3}), 0.5, 1e-12);
  EXPECT_NEAR(graph.ApartInFirstSplit({4, 5}), 0, 1e-12);
  EXPECT_NEAR(graph.ApartInFirstSplit({0, 5}), 1, 1e-12);
  graph.Merge(3, 4);
  EXPECT_NEAR(graph.ApartInFirstSplit({2, 3}), 0.75, 1e-12);
  EXPECT_NEAR(graph.ApartInFirstSplit({3, 5}), 0.25, 1e-12);
}

TEST(PieceGraphTest, LinksAreBoundariesToo) {
  const TriangleMesh mesh = Apart(Icosphere(1), Icosphere(1));
  const Adjacency adjacency(mesh);
  const uint32_t half = mesh.NumFaces() / 2;
  std::vector<uint32_t> shell(mesh.NumFaces());
  for (uint32_t f = half; f < shell.size(); ++f) shell[f] = 1;
  const std::vector<Bridge> bridges = {{mesh.faces[2][0], mesh.faces[half][0]},
                                       {mesh.faces[9][1], mesh.faces[half][0]}};
  const FaceLinks links(adjacency, bridges);
  PieceGraph graph(adjacency, shell, FaceAreaShares(mesh), links);
  ASSERT_EQ(graph.boundaries().size(), 1u);
  EXPECT_TRUE(graph.boundaries().at({0, 1}).empty());
  graph.Merge(0, 1);
  EXPECT_TRUE(graph.boundaries().empty());
  EXPECT_TRUE(
      PieceGraph(adjacency, shell, FaceAreaShares(mesh)).boundaries().empty());
}

}  // namespace
}  // namespace marrow
