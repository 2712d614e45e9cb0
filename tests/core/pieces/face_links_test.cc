#include "core/pieces/face_links.h"

#include <array>
#include <vector>

#include "core/pieces/fronts.h"
#include "core/pieces/region.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<uint32_t> LinksOf(const FaceLinks& links, uint32_t f) {
  return {links.Of(f).begin(), links.Of(f).end()};
}

// Three triangles apart: vertices 0 to 2, 3 to 5 and 6 to 8.
TriangleMesh Three() {
  return Apart(Apart(SingleTriangle(), SingleTriangle()), SingleTriangle());
}

TEST(FaceLinksTest, GoBothWaysAndAreThereOnce) {
  const TriangleMesh mesh = Three();
  const std::vector<std::array<uint32_t, 2>> bridges = {{0, 3}, {1, 4}, {2, 8}};
  const FaceLinks links(Adjacency(mesh), bridges);
  EXPECT_FALSE(links.empty());
  EXPECT_THAT(LinksOf(links, 0), ElementsAre(1, 2));
  EXPECT_THAT(LinksOf(links, 1), ElementsAre(0));
  EXPECT_THAT(LinksOf(links, 2), ElementsAre(0));
}

TEST(FaceLinksTest, ShellsThatTouchInAVertexAreLinked) {
  // 0 and 1 share an edge, 2 touches both, 3 and 4 touch 2.
  TriangleMesh mesh;
  mesh.positions = Positions::Random(9, 3);
  mesh.faces = {{0, 1, 2}, {1, 3, 2}, {2, 4, 5}, {4, 6, 7}, {4, 7, 8}};
  const FaceLinks links(Adjacency(mesh), {});
  EXPECT_THAT(LinksOf(links, 0), ElementsAre(2));
  EXPECT_THAT(LinksOf(links, 1), IsEmpty());
  EXPECT_THAT(LinksOf(links, 2), ElementsAre(0, 3));
  EXPECT_THAT(LinksOf(links, 3), ElementsAre(2));
  EXPECT_THAT(LinksOf(links, 4), IsEmpty());
}

TEST(FaceLinksTest, NoBridgesAreNoLinks) {
  EXPECT_TRUE(FaceLinks(Adjacency(Three()), {}).empty());
  EXPECT_THAT(LinksOf(FaceLinks(), 7), IsEmpty());
}

TEST(FaceLinksTest, ARegionHasThoseWithBothEndsInIt) {
  const TriangleMesh mesh = Three();
  const Adjacency adjacency(mesh);
  const std::vector<std::array<uint32_t, 2>> bridges = {{2, 3}, {5, 6}};
  const FaceLinks links(adjacency, bridges);
  const std::vector<double> areas(3, 1.0 / 3);
  const Region last(mesh, adjacency, areas, {1, 2}, links);
  using Pair = std::array<uint32_t, 2>;
  EXPECT_THAT(last.links(), ElementsAre(Pair{0, 1}, Pair{1, 0}));
  EXPECT_EQ(last.LinksOf(1).size(), 1u);
  EXPECT_THAT(ConnectedPieces(last.adjacency(), {0, 0}, last.links()),
              ElementsAre(0, 0));
  EXPECT_THAT(ConnectedPieces(last.adjacency(), {0, 0}), ElementsAre(0, 1));
  EXPECT_THAT(ConnectedPieces(last.adjacency(), {0, 1}, last.links()),
              ElementsAre(0, 1));
  const Region ends(mesh, adjacency, areas, {0, 2}, links);
  EXPECT_THAT(ends.links(), IsEmpty());
}

// Two fronts at the ends of a row of shells meet in the middle one: without
// links the shells between would go to one of them as a whole.
TEST(FaceLinksTest, FrontsCrossThem) {
  TriangleMesh mesh;
  mesh.positions.resize(24, 3);
  std::vector<std::array<uint32_t, 2>> bridges;
  DiffusionMap Phi(24, 1);
  for (uint32_t f = 0; f < 8; ++f) {
    mesh.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    for (uint32_t v = 3 * f; v < 3 * f + 3; ++v) {
      mesh.positions.row(v) << f, v % 3, v % 2;
      Phi(v, 0) = f;
    }
    if (f > 0) bridges.push_back({3 * f - 1, 3 * f});
  }
  const Adjacency adjacency(mesh);
  const Region region(mesh, adjacency, std::vector<double>(8, 0.125),
                      {0, 1, 2, 3, 4, 5, 6, 7}, FaceLinks(adjacency, bridges));
  EXPECT_THAT(CompeteFronts(region, MapSketch(Phi), {{0}, {21}}, CancelToken()),
              ElementsAre(0, 0, 0, 0, 1, 1, 1, 1));
}

}  // namespace
}  // namespace marrow
