#include "core/operators/seams.h"

#include <gtest/gtest.h>

#include <set>

#include "core/mesh/adjacency.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// Vertices of an open tube around z with `around` on each of its rings.
TriangleMesh Tube(uint32_t around, uint32_t rings, double from, double turn) {
  TriangleMesh mesh;
  mesh.positions.resize(around * rings, 3);
  for (uint32_t ring = 0; ring < rings; ++ring)
    for (uint32_t i = 0; i < around; ++i) {
      const double angle = 2 * 3.141592653589793 * (i + turn) / around;
      mesh.positions.row(ring * around + i) << std::cos(angle), std::sin(angle),
          from + 0.3 * ring;
    }
  for (uint32_t ring = 0; ring + 1 < rings; ++ring)
    for (uint32_t i = 0; i < around; ++i) {
      const uint32_t a = ring * around + i;
      const uint32_t b = ring * around + (i + 1) % around;
      mesh.faces.push_back({a, b, b + around});
      mesh.faces.push_back({a, b + around, a + around});
    }
  return mesh;
}

TriangleMesh Both(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  both.positions.conservativeResize(a.NumVertices() + b.NumVertices(), 3);
  both.positions.bottomRows(b.NumVertices()) = b.positions;
  const uint32_t n = a.NumVertices();
  for (const Triangle& f : b.faces)
    both.faces.push_back({f[0] + n, f[1] + n, f[2] + n});
  return both;
}

size_t CountSewn(const std::vector<uint32_t>& sewn) {
  size_t count = 0;
  for (uint32_t v = 0; v < sewn.size(); ++v) {
    EXPECT_LE(sewn[v], v);
    EXPECT_EQ(sewn[sewn[v]], sewn[v]);
    count += sewn[v] != v;
  }
  return count;
}

TEST(SeamsTest, FacingRimsBecomeOne) {
  const TriangleMesh mesh =
      Both(Tube(12, 4, 0, 0), Tube(12, 4, 0.95, 0.2));  // ends at .9
  const std::vector<uint32_t> sewn = SewRims(mesh, 0.3);
  EXPECT_EQ(CountSewn(sewn), 12u);
  // Corner by corner, all the way round.
  std::set<uint32_t> upper;
  for (uint32_t v = 48; v < 60; ++v) upper.insert(sewn[v]);
  EXPECT_EQ(upper.size(), 12u);
  EXPECT_EQ(*upper.begin(), 36u);
  EXPECT_EQ(*upper.rbegin(), 47u);
  // No farther than allowed.
  EXPECT_EQ(CountSewn(SewRims(mesh, 0.04)), 0u);
}

// A third tube in the middle of both rims is sewn to one of each at most.
TEST(SeamsTest, NoTwoOfOneComponent) {
  const TriangleMesh mesh = Both(Both(Tube(12, 4, 0, 0), Tube(24, 4, 0.95, 0)),
                                 Tube(17, 2, 0.925, 0.3));
  const std::vector<uint32_t> sewn = SewRims(mesh, 0.6);
  const auto component = [](uint32_t v) {
    return v < 48 ? 0 : v < 144 ? 1 : 2;
  };
  std::set<std::pair<uint32_t, int>> seen;
  for (uint32_t v = 0; v < sewn.size(); ++v)
    EXPECT_TRUE(seen.insert({sewn[v], component(v)}).second) << v;
}

TEST(SeamsTest, NoFaceIsLost) {
  // Two vertices of the upper rim for each of the lower.
  const TriangleMesh mesh = Both(Tube(12, 4, 0, 0), Tube(24, 4, 0.95, 0));
  const std::vector<uint32_t> sewn = SewRims(mesh, 0.6);
  EXPECT_GE(CountSewn(sewn), 12u);
  for (const auto& [a, b, c] : mesh.faces)
    EXPECT_TRUE(sewn[a] != sewn[b] && sewn[b] != sewn[c] && sewn[c] != sewn[a]);
}

// The two rims of one tube are not sewn, nor is what has none.
// Triangles that shrank to .7 of themselves: every vertex is found again.
TEST(SeamsTest, ShredsBecomeOneSurface) {
  const TriangleMesh ball = Icosphere(3);
  TriangleMesh shreds;
  shreds.positions.resize(3 * ball.NumFaces(), 3);
  for (uint32_t f = 0; f < ball.NumFaces(); ++f) {
    const auto& [a, b, c] = ball.faces[f];
    const Eigen::Vector3d centre =
        (ball.Position(a) + ball.Position(b) + ball.Position(c)) / 3;
    for (uint32_t i = 0; i < 3; ++i)
      shreds.positions.row(3 * f + i) =
          (centre + 0.7 * (ball.Position(ball.faces[f][i]) - centre))
              .transpose();
    shreds.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  const auto sewn = SewShreds(shreds, CancelToken());
  ASSERT_TRUE(sewn.ok()) << sewn.status();
  EXPECT_EQ(CountSewn(*sewn), shreds.NumVertices() - ball.NumVertices());
}

TEST(SeamsTest, OnlyRimsOfDifferentComponents) {
  EXPECT_EQ(CountSewn(SewRims(Tube(12, 2, 0, 0), 1)), 0u);
  EXPECT_EQ(CountSewn(SewRims(Both(Icosphere(1), Tube(12, 2, 1.05, 0)), 1)),
            0u);
}

}  // namespace
}  // namespace marrow
