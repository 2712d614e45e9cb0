#include "core/hierarchy/fine_tree.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "gtest/gtest.h"
#include "tests/testing/invariants.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// A ball, and what is left of it.
class FineTreeTest : public testing::Test {
 protected:
  static double X(const TriangleMesh& mesh, uint32_t f) {
    double x = 0;
    for (uint32_t v : mesh.faces[f]) x += mesh.Position(v).x() / 3;
    return x;
  }

  // The root, and a child on either side of x = 0, whose medial structures are
  // vertices of their own.
  SegmentTree TwoHalves() const {
    const TriangleMesh& mesh = coarse_.canonical.mesh;
    SegmentTree tree;
    tree.nodes.resize(3);
    for (uint32_t id = 0; id < 3; ++id) tree.nodes[id].id = id;
    tree.nodes[0].children = {1, 2};
    for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
      tree.nodes[0].faces.push_back(f);
      tree.nodes[X(mesh, f) > 0 ? 2 : 1].faces.push_back(f);
    }
    for (SegmentNode& node : tree.nodes) {
      node.medial_structure = {mesh.faces[node.faces[0]][0]};
      if (node.id > 0) node.parent = 0, node.level = 1;
    }
    return tree;
  }

  void ExpectHalves(const SegmentTree& tree) const {
    ASSERT_EQ(tree.nodes.size(), 3u);
    EXPECT_EQ(tree.nodes[0].faces.size(), fine_.NumFaces());
    std::vector<uint32_t> both = tree.nodes[1].faces;
    both.insert(both.end(), tree.nodes[2].faces.begin(),
                tree.nodes[2].faces.end());
    std::sort(both.begin(), both.end());
    EXPECT_EQ(both, tree.nodes[0].faces);
    const Adjacency adjacency(fine_);
    for (const SegmentNode& node : tree.nodes) {
      EXPECT_EQ(CountPieces(adjacency, node.faces), 1u);
      const std::vector<uint32_t> own = VerticesOf(fine_, node.faces);
      for (uint32_t v : node.medial_structure)
        EXPECT_TRUE(std::binary_search(own.begin(), own.end(), v));
    }
    for (uint32_t id : {1, 2})
      for (uint32_t f : tree.nodes[id].faces)
        EXPECT_LT(id == 1 ? X(fine_, f) : -X(fine_, f), 0.3);
  }

  const TriangleMesh fine_ = CanonicalOf(Icosphere(5)).mesh;
  const CoarseMesh coarse_ = Coarsen(fine_, 1'000);
};

TEST_F(FineTreeTest, NodesHaveThePatchesOfTheirFaces) {
  const SegmentTree tree = ToFine(TwoHalves(), coarse_, fine_);
  ExpectHalves(tree);
  for (uint32_t f : tree.nodes[1].faces)
    EXPECT_LE(X(coarse_.canonical.mesh, coarse_.coarse_face[f]), 0);
}

TEST_F(FineTreeTest, MergedPiecesHaveShorterBoundaries) {
  MergeTree merged;
  merged.tree = TwoHalves();
  merged.order = {2, {{0, 1, 0.5}}};
  for (uint32_t f = 0; f < coarse_.faces.size(); ++f)
    merged.piece_of_face.push_back(X(coarse_.canonical.mesh, f) > 0);
  const Adjacency adjacency(fine_);
  const auto result = ToFine(merged, coarse_, fine_, fine_.NumFaces(),
                             adjacency, {}, CancelToken());
  ASSERT_TRUE(result.ok()) << result.status();
  ExpectHalves(result->tree);
  EXPECT_EQ(result->order.merges.size(), 1u);
  const auto Length = [&](const SegmentTree& tree) {
    std::vector<bool> left(fine_.NumFaces(), false);
    for (uint32_t f : tree.nodes[1].faces) left[f] = true;
    double sum = 0;
    for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
      const auto faces = adjacency.EdgeFaces(e);
      const auto [a, b] = adjacency.EdgeVertices(e);
      if (left[faces[0]] != left[faces[1]])
        sum += (fine_.Position(a) - fine_.Position(b)).norm();
    }
    return sum;
  };
  const double before = Length(ToFine(merged.tree, coarse_, fine_));
  EXPECT_LT(Length(result->tree), 0.95 * before);
}

TEST_F(FineTreeTest, PatchesAreNotToldOf) {
  const SegmentTree tree = ToFine(TwoHalves(), coarse_, fine_);
  const uint32_t count = fine_.NumFaces() / 2;
  const SegmentTree own = WithoutPatches(tree, fine_, count);
  ASSERT_EQ(own.nodes.size(), tree.nodes.size());
  EXPECT_EQ(own.nodes[0].faces.size(), count);
  for (const SegmentNode& node : own.nodes) {
    EXPECT_LT(node.faces.back(), count);
    EXPECT_FALSE(node.medial_structure.empty());
    for (uint32_t v : node.medial_structure)
      EXPECT_TRUE(std::ranges::any_of(node.faces, [&](uint32_t f) {
        return std::ranges::count(fine_.faces[f], v) > 0;
      }));
  }
}

// What a segment loses to its neighbour may be all of its medial structure.
TEST_F(FineTreeTest, AMedialStructureIsNeverEmpty) {
  const std::vector<uint32_t> faces = {7};
  const uint32_t v = fine_.faces[7][0];
  std::vector<uint32_t> elsewhere;
  for (uint32_t c = 0; c < coarse_.vertices.size(); ++c) {
    const auto& corners = fine_.faces[7];
    if (std::count(corners.begin(), corners.end(), coarse_.vertices[c]) == 0)
      elsewhere.push_back(c);
  }
  EXPECT_EQ(ToFine(elsewhere, coarse_, fine_, faces), std::vector<uint32_t>{v});
}

}  // namespace
}  // namespace marrow
