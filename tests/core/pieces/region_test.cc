#include "core/pieces/region.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;

std::vector<uint32_t> Span(uint32_t begin, uint32_t end) {
  std::vector<uint32_t> values(end - begin);
  std::iota(values.begin(), values.end(), begin);
  return values;
}

// Equal shares.
Region RegionOf(const TriangleMesh& mesh, const std::vector<uint32_t>& faces) {
  return Region(mesh, Adjacency(mesh),
                std::vector<double>(mesh.NumFaces(), 1.0 / mesh.NumFaces()),
                faces);
}

// Rings `first` to `last` of faces of a disk, counted from 1.
std::vector<uint32_t> RingFaces(uint32_t first, uint32_t last) {
  return Span(6 * (first - 1) * (first - 1), 6 * last * last);
}
// The vertices of one ring of a disk.
std::vector<uint32_t> RingVertices(uint32_t ring) {
  return Span(1 + 3 * ring * (ring - 1), 1 + 3 * ring * (ring + 1));
}

std::vector<uint32_t> LoopInMesh(const Region& region, uint32_t mesh_vertex) {
  const auto& vertices = region.mesh_vertices();
  const auto at = std::find(vertices.begin(), vertices.end(), mesh_vertex);
  std::vector<uint32_t> loop;
  for (uint32_t v :
       region.BoundaryLoop(static_cast<uint32_t>(at - vertices.begin())))
    loop.push_back(vertices[v]);
  return loop;
}

TEST(RegionTest, NumbersItsOwnInTheOrderOfTheMesh) {
  const TriangleMesh mesh = Grid(3, 2);
  const std::vector<uint32_t> faces = {1, 4, 5, 10};
  const Region region = RegionOf(mesh, faces);
  ASSERT_EQ(region.NumFaces(), 4u);
  EXPECT_TRUE(std::ranges::is_sorted(region.mesh_vertices()));
  for (uint32_t f = 0; f < 4; ++f) {
    EXPECT_EQ(region.MeshFace(f), faces[f]);
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(region.mesh_vertices()[region.triangles()[f][i]],
                mesh.faces[faces[f]][i]);
  }
  EXPECT_DOUBLE_EQ(region.area(), 4.0 / 12);
  EXPECT_THAT(region.AllFaces(), ElementsAre(0, 1, 2, 3));
}

TEST(RegionTest, AnAnnulusHasTwoLoops) {
  const Region region = RegionOf(Disk(6), RingFaces(3, 5));
  EXPECT_THAT(LoopInMesh(region, RingVertices(2)[3]),
              ElementsAreArray(RingVertices(2)));
  EXPECT_THAT(LoopInMesh(region, RingVertices(5)[7]),
              ElementsAreArray(RingVertices(5)));
}

TEST(RegionTest, AnInnerVertexIsItsOwnLoop) {
  const Region region = RegionOf(Disk(6), RingFaces(3, 5));
  EXPECT_THAT(LoopInMesh(region, RingVertices(4)[1]),
              ElementsAre(RingVertices(4)[1]));
}

TEST(RegionTest, TheRimOfTheMeshIsNoLoop) {
  const Region region = RegionOf(Disk(5), RingFaces(3, 5));
  EXPECT_THAT(LoopInMesh(region, RingVertices(5)[7]),
              ElementsAre(RingVertices(5)[7]));
  EXPECT_THAT(LoopInMesh(region, RingVertices(2)[0]),
              ElementsAreArray(RingVertices(2)));
}

TEST(RegionTest, LoopsThatTouchAreOne) {
  // Without two squares that share the corner (2, 2).
  const TriangleMesh mesh = Grid(4, 4);
  auto square = [](uint32_t x, uint32_t y) { return 2 * (4 * x + y); };
  std::vector<uint32_t> faces;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (f / 2 * 2 != square(1, 1) && f / 2 * 2 != square(2, 2))
      faces.push_back(f);
  auto vertex = [](uint32_t x, uint32_t y) { return 5 * x + y; };
  EXPECT_THAT(
      LoopInMesh(RegionOf(mesh, faces), vertex(1, 1)),
      ElementsAre(vertex(1, 1), vertex(1, 2), vertex(2, 1), vertex(2, 2),
                  vertex(2, 3), vertex(3, 2), vertex(3, 3)));
}

TEST(RegionTest, APageOfABookMeetsTheRestAtTheSpine) {
  const Region region = RegionOf(Book(4, 3), Span(0, 6));
  EXPECT_THAT(LoopInMesh(region, 2), ElementsAre(0, 1, 2, 3));
}

// By flooding.
std::vector<uint32_t> NaivePieces(const Adjacency& adjacency,
                                  const std::vector<uint32_t>& labels) {
  std::vector<uint32_t> piece(labels.size(), kNoIndex);
  uint32_t count = 0;
  for (uint32_t start = 0; start < piece.size(); ++start) {
    if (piece[start] != kNoIndex) continue;
    std::vector<uint32_t> stack = {start};
    piece[start] = count;
    while (!stack.empty()) {
      const uint32_t f = stack.back();
      stack.pop_back();
      for (uint32_t e : adjacency.FaceEdges(f))
        for (uint32_t g : adjacency.EdgeFaces(e))
          if (piece[g] == kNoIndex && labels[g] == labels[f]) {
            piece[g] = count;
            stack.push_back(g);
          }
    }
    ++count;
  }
  return piece;
}

TEST(ConnectedPiecesTest, AgreesWithFloodingOnAllShapes) {
  std::mt19937 random(3);
  for (const auto& [name, mesh] : AllShapes()) {
    const Adjacency adjacency(mesh);
    for (uint32_t num_labels : {1, 2, 5}) {
      std::vector<uint32_t> labels(mesh.NumFaces());
      for (uint32_t& label : labels) label = random() % num_labels;
      EXPECT_EQ(ConnectedPieces(adjacency, labels),
                NaivePieces(adjacency, labels))
          << name;
    }
  }
}

}  // namespace
}  // namespace marrow
