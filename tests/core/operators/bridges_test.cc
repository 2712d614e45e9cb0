#include "core/operators/bridges.h"

#include <algorithm>
#include <limits>
#include <random>
#include <tuple>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/cpu_time.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using Bridges = std::vector<Bridge>;

constexpr double kAnyLength = std::numeric_limits<double>::infinity();

DisjointSets ComponentsOf(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.NumVertices());
  for (const Triangle& face : mesh.faces)
    for (int i = 1; i < 3; ++i) sets.Union(face[0], face[i]);
  return sets;
}

// Kruskal over all pairs of vertices.
Bridges BruteForce(const TriangleMesh& mesh) {
  std::vector<std::tuple<double, uint32_t, uint32_t>> pairs;
  for (uint32_t a = 0; a < mesh.NumVertices(); ++a)
    for (uint32_t b = a + 1; b < mesh.NumVertices(); ++b)
      pairs.push_back(
          {(mesh.Position(a) - mesh.Position(b)).squaredNorm(), a, b});
  std::sort(pairs.begin(), pairs.end());
  DisjointSets sets = ComponentsOf(mesh);
  Bridges bridges;
  for (const auto& [distance, a, b] : pairs)
    if (sets.Union(a, b)) bridges.push_back({a, b});
  std::sort(bridges.begin(), bridges.end());
  return bridges;
}

// Lone triangles and pairs of triangles, too small to be coarse: `place` gives
// the coordinates of where they are, `corner` those of a corner from there.
template <typename Coordinate, typename Offset>
TriangleMesh Cloud(uint32_t bodies, std::mt19937& random,
                   const Coordinate& place, const Offset& corner) {
  TriangleMesh mesh;
  uint32_t n = 0;
  std::vector<uint32_t> first;
  for (uint32_t body = 0; body < bodies; ++body) {
    first.push_back(n);
    mesh.faces.push_back({n, n + 1, n + 2});
    n += 3;
    if (random() % 2) {
      mesh.faces.push_back({n - 1, n - 2, n});
      ++n;
    }
  }
  first.push_back(n);
  mesh.positions.resize(n, 3);
  for (uint32_t body = 0; body < bodies; ++body) {
    const Eigen::RowVector3d at(place(), place(), place());
    for (uint32_t v = first[body]; v < first[body + 1]; ++v)
      mesh.positions.row(v) =
          at + Eigen::RowVector3d(corner(), corner(), corner());
  }
  return mesh;
}

TEST(BridgesTest, NoneForOnePiece) {
  EXPECT_THAT(FindBridges(Icosphere(1)), ::testing::IsEmpty());
  EXPECT_THAT(FindBridges(Bowtie(2)), ::testing::IsEmpty());
}

TEST(BridgesTest, AreAMinimumSpanningTreeOfRandomClouds) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const TriangleMesh mesh = Cloud(
        2 + 2 * seed, random, [&] { return random() * 0x1p-32; },
        [&] { return random() * 0x1p-38; });
    EXPECT_EQ(SpanningBridges(mesh, kAnyLength), BruteForce(mesh)) << seed;
  }
}

// On a lattice almost all distances have equals: the least vertices win.
TEST(BridgesTest, BreakTiesByTheLeastVertices) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    TriangleMesh mesh = Cloud(
        60, random, [&] { return random() % 32; },
        [&] { return random() % 2; });
    // A power of two as extent keeps scaled distances exact.
    TriangleMesh corner = SingleTriangle();
    corner.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0;
    for (double at : {0, 32}) {
      const uint32_t n = mesh.NumVertices();
      mesh.positions.conservativeResize(n + 3, 3);
      mesh.positions.bottomRows(3) = (at - corner.positions.array()).abs();
      mesh.faces.push_back({n, n + 1, n + 2});
    }
    EXPECT_EQ(SpanningBridges(mesh, kAnyLength), BruteForce(mesh)) << seed;
  }
}

TEST(BridgesTest, StopAtTheLongest) {
  for (uint32_t seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    const TriangleMesh mesh = Cloud(
        40, random, [&] { return random() * 0x1p-32; },
        [&] { return random() * 0x1p-38; });
    Bridges expected = SpanningBridges(mesh, kAnyLength);
    const size_t all = expected.size();
    constexpr double kLongest = 0.08;
    std::erase_if(expected, [&](const Bridge& b) {
      return (mesh.Position(b[0]) - mesh.Position(b[1])).norm() > kLongest;
    });
    EXPECT_LT(expected.size(), all);
    EXPECT_EQ(SpanningBridges(mesh, kLongest), expected) << seed;
  }
}

TEST(BridgesTest, EveryVertexOfANearZoneHasOne) {
  // Two grids, an edge of each half a square from one of the other.
  TriangleMesh mesh = Apart(Grid(24, 18), Grid(24, 18));
  const uint32_t n = mesh.NumVertices() / 2;
  for (uint32_t v = n; v < 2 * n; ++v) mesh.positions(v, 0) -= 0.5;
  for (const auto& [u, v] : FindBridges(mesh)) {
    EXPECT_EQ(mesh.positions(u, 0), 24);
    EXPECT_EQ(mesh.positions(v, 0), 24.5);
    EXPECT_EQ(mesh.positions(v, 1), mesh.positions(u, 1));
  }
  EXPECT_EQ(FindBridges(mesh).size(), 19u);
}

// A post of twelve faces in the middle of a sheet of two: its corners are
// nearest to points inside those.
TEST(BridgesTest, SeeInsideCoarseFaces) {
  TriangleMesh sheet = Scaled(Grid(1, 1), 10);
  TriangleMesh post = CubesSurface({{0, 0, 0}}, 1);
  post.positions.rowwise() += Eigen::RowVector3d(6, 3, 0.01);
  const uint32_t n = sheet.NumVertices();
  sheet.positions.conservativeResize(n + post.NumVertices(), 3);
  sheet.positions.bottomRows(post.NumVertices()) = post.positions;
  for (const auto& [a, b, c] : post.faces)
    sheet.faces.push_back({n + a, n + b, n + c});
  EXPECT_FALSE(SpanningBridges(sheet, BridgingDistance(sheet)).empty());
  post.positions.rowwise() += Eigen::RowVector3d(0, 0, 1);
  sheet.positions.bottomRows(post.NumVertices()) = post.positions;
  EXPECT_TRUE(SpanningBridges(sheet, BridgingDistance(sheet)).empty());
}

TEST(BridgesTest, TheDistanceIsTheMeanEdgeWithinItsBounds) {
  const double diagonal = std::sqrt(200.0);
  EXPECT_NEAR(BridgingDistance(Grid(10, 10)), 0.03 * diagonal, 1e-12);
  const double fine = std::sqrt(2 * 400.0 * 400.0);
  EXPECT_NEAR(BridgingDistance(Grid(400, 400)), 0.01 * fine, 1e-9);
  const TriangleMesh grid = Grid(60, 60);
  const double mean = (2 + std::sqrt(2.0)) / 3;
  EXPECT_NEAR(BridgingDistance(Scaled(grid, 1e30)), mean * 1e30, 1e20);
}

TEST(BridgesTest, JoinBodiesAtAnyScale) {
  const TriangleMesh mesh = Apart(Apart(Icosphere(2), Disk(3)), Tetrahedron());
  const Bridges bridges = FindBridges(mesh);
  ASSERT_EQ(bridges.size(), 2u);
  DisjointSets sets = ComponentsOf(mesh);
  for (const auto& [a, b] : bridges) EXPECT_TRUE(sets.Union(a, b));
  EXPECT_EQ(FindBridges(Scaled(mesh, 0x1p-66)), bridges);
  EXPECT_EQ(FindBridges(Scaled(mesh, 0x1p66)), bridges);
}

// Two large bodies far apart: whoever searches his own body first looks at
// 10^9 pairs here.
TEST(BridgesTest, LargeBodiesFarApartStayQuick) {
  const TriangleMesh sphere = Icosphere(6);
  TriangleMesh mesh = Apart(sphere, sphere);
  for (uint32_t v = sphere.NumVertices(); v < mesh.NumVertices(); ++v)
    mesh.positions(v, 0) += 1000;
  const double start = CpuSeconds();
  EXPECT_EQ(FindBridges(mesh).size(), 1u);
  EXPECT_LT(CpuSeconds() - start, Allowed(1));
}

TEST(BridgesTest, ManyBodiesStayQuick) {
  std::mt19937 random(1);
  const TriangleMesh mesh = Cloud(
      20'000, random, [&] { return random() * 0x1p-32; },
      [&] { return random() * 0x1p-38; });
  const double start = CpuSeconds();
  EXPECT_EQ(SpanningBridges(mesh, kAnyLength).size(), 19'999u);
  EXPECT_LT(CpuSeconds() - start, Allowed(5));
}

}  // namespace
}  // namespace marrow
