#include "core/mesh/adjacency.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TriangleMesh MeshOf(uint32_t num_vertices, std::vector<Triangle> faces) {
  TriangleMesh mesh;
  mesh.positions = Positions::Zero(num_vertices, 3);
  mesh.faces = std::move(faces);
  return mesh;
}

// A page is a triangle on the spine 0-1.
TriangleMesh Book(uint32_t pages) {
  std::vector<Triangle> faces;
  for (uint32_t i = 0; i < pages; ++i) faces.push_back({0, 1, i + 2});
  return MeshOf(pages + 2, std::move(faces));
}

TEST(AdjacencyTest, EmptyMesh) {
  const Adjacency adjacency(MeshOf(0, {}));
  EXPECT_EQ(adjacency.NumVertices(), 0u);
  EXPECT_EQ(adjacency.NumEdges(), 0u);
  EXPECT_EQ(adjacency.NumFaces(), 0u);
}

TEST(AdjacencyTest, TwoTrianglesAndAnUnusedVertex) {
  const Adjacency adjacency(MeshOf(5, {{0, 1, 2}, {2, 1, 3}}));
  ASSERT_EQ(adjacency.NumEdges(), 5u);
  EXPECT_THAT(adjacency.EdgeVertices(0), ElementsAre(0, 1));
  EXPECT_THAT(adjacency.EdgeVertices(1), ElementsAre(0, 2));
  EXPECT_THAT(adjacency.EdgeVertices(2), ElementsAre(1, 2));
  EXPECT_THAT(adjacency.EdgeVertices(3), ElementsAre(1, 3));
  EXPECT_THAT(adjacency.EdgeVertices(4), ElementsAre(2, 3));
  EXPECT_THAT(adjacency.EdgeFaces(2), ElementsAre(0, 1));
  EXPECT_FALSE(adjacency.IsBoundaryEdge(2));
  EXPECT_THAT(adjacency.EdgeFaces(4), ElementsAre(1));
  EXPECT_TRUE(adjacency.IsBoundaryEdge(4));
  EXPECT_THAT(adjacency.FaceEdges(0), ElementsAre(0, 2, 1));
  EXPECT_THAT(adjacency.FaceEdges(1), ElementsAre(2, 3, 4));
  EXPECT_THAT(adjacency.VertexFaces(1), ElementsAre(0, 1));
  EXPECT_THAT(adjacency.VertexFaces(3), ElementsAre(1));
  EXPECT_THAT(adjacency.VertexFaces(4), IsEmpty());
}

// Quadratic storage of this edge's pairs would be 80 GB.
TEST(AdjacencyTest, BookOfManyPages) {
  const uint32_t pages = 100'000;
  const Adjacency adjacency(Book(pages));
  EXPECT_EQ(adjacency.NumEdges(), 2 * pages + 1);
  ASSERT_EQ(adjacency.EdgeFaces(0).size(), pages);
  EXPECT_TRUE(std::ranges::is_sorted(adjacency.EdgeFaces(0)));
  EXPECT_EQ(adjacency.VertexFaces(0).size(), pages);
}

TEST(AdjacencyTest, AgreesWithSetsOfPairs) {
  std::vector<Triangle> faces;
  uint32_t state = 1;
  while (faces.size() < 400) {
    Triangle face;
    for (uint32_t& v : face) {
      state = state * 1664525u + 1013904223u;
      v = (state >> 16) % 40;
    }
    if (std::set<uint32_t>(face.begin(), face.end()).size() == 3) {
      faces.push_back(face);
    }
  }
  std::map<std::array<uint32_t, 2>, std::set<uint32_t>> expected;
  std::vector<std::set<uint32_t>> around(40);
  for (uint32_t f = 0; f < faces.size(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t a = faces[f][i], b = faces[f][(i + 1) % 3];
      expected[{std::min(a, b), std::max(a, b)}].insert(f);
      around[a].insert(f);
    }
  }

  const Adjacency adjacency(MeshOf(40, faces));
  ASSERT_EQ(adjacency.NumEdges(), expected.size());
  uint32_t e = 0;
  for (const auto& [vertices, edge_faces] : expected) {
    EXPECT_EQ(adjacency.EdgeVertices(e), vertices);
    EXPECT_THAT(adjacency.EdgeFaces(e),
                ::testing::ElementsAreArray(edge_faces));
    ++e;
  }
  for (uint32_t v = 0; v < 40; ++v) {
    EXPECT_THAT(adjacency.VertexFaces(v),
                ::testing::ElementsAreArray(around[v]));
  }
  for (uint32_t f = 0; f < faces.size(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t a = faces[f][i], b = faces[f][(i + 1) % 3];
      EXPECT_THAT(adjacency.EdgeVertices(adjacency.FaceEdges(f)[i]),
                  ElementsAre(std::min(a, b), std::max(a, b)));
    }
  }
}

}  // namespace
}  // namespace marrow
