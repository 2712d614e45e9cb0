#include "core/boundaries/min_cut.h"

#include <array>
#include <limits>
#include <random>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace marrow {
namespace {

using Side = MinCut::Side;
using ::testing::ElementsAre;

struct Edge {
  uint32_t a, b;
  double cost;
};

// Nodes 0 .. n - 1; n is the source and n + 1 the sink.
struct Graph {
  uint32_t n;
  std::vector<Edge> edges;
};

std::vector<Side> Solve(const Graph& graph) {
  MinCut cut(graph.n);
  for (const Edge& edge : graph.edges) {
    if (edge.b == graph.n) {
      cut.ConnectToSource(edge.a, edge.cost);
    } else if (edge.b == graph.n + 1) {
      cut.ConnectToSink(edge.a, edge.cost);
    } else {
      cut.Connect(edge.a, edge.b, edge.cost);
    }
  }
  return cut.Solve();
}

// What it costs to have the nodes of `on_source` there and all others not.
double CostOf(const Graph& graph, uint32_t on_source) {
  const uint32_t with_terminals = on_source | (1u << graph.n);
  double cost = 0;
  for (const Edge& edge : graph.edges)
    if (((with_terminals >> edge.a) ^ (with_terminals >> edge.b)) & 1u)
      cost += edge.cost;
  return cost;
}

TEST(MinCutTest, CutsAChainAtItsWeakestEdge) {
  EXPECT_THAT(
      Solve({4, {{0, 4, 9}, {0, 1, 3}, {1, 2, 1}, {2, 3, 2}, {3, 5, 9}}}),
      ElementsAre(Side::kSource, Side::kSource, Side::kSink, Side::kSink));
}

TEST(MinCutTest, OfEqualCutsTakesTheOneNextToTheSource) {
  EXPECT_THAT(
      Solve({4, {{0, 4, 9}, {0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 5, 9}}}),
      ElementsAre(Side::kSource, Side::kSink, Side::kSink, Side::kSink));
}

TEST(MinCutTest, NodesThatReachNoTerminalAreOnNeitherSide) {
  EXPECT_THAT(
      Solve({4, {{0, 4, 1}, {1, 5, 1}, {2, 3, 1}}}),
      ElementsAre(Side::kSource, Side::kSink, Side::kNeither, Side::kNeither));
}

TEST(MinCutTest, CostsNoMoreThanAnyOtherCut) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    Graph graph{2 + static_cast<uint32_t>(random() % 7), {}};
    for (uint32_t a = 0; a < graph.n; ++a)
      for (uint32_t b = a + 1; b < graph.n + 2; ++b)
        if (random() % 2) graph.edges.push_back({a, b, random() % 100 / 10.0});
    uint32_t mine = 0;
    const std::vector<Side> sides = Solve(graph);
    for (uint32_t v = 0; v < graph.n; ++v)
      if (sides[v] == Side::kSource) mine |= 1u << v;
    double least = std::numeric_limits<double>::max();
    for (uint32_t other = 0; other < 1u << graph.n; ++other)
      least = std::min(least, CostOf(graph, other));
    ASSERT_NEAR(CostOf(graph, mine), least, 1e-9) << "trial " << trial;
  }
}

}  // namespace
}  // namespace marrow
