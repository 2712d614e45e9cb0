#include "core/hierarchy/tree_builder.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/invariants.h"
#include "tests/testing/shapes.h"
#include "tests/testing/solved_mesh.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

class TreeOfAnyShape : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(TreeOfAnyShape, KeepsItsInvariantsAtEveryDepth) {
  const SolvedMesh solved = SolveMesh(GetParam().mesh, 60);
  const CancelToken cancel;
  for (double kappa : {1.5, 0.4}) {
    TreeBuilder builder(solved.context(), SplitOptions{.kappa = kappa},
                        solved.canonical.report.area);
    EXPECT_EQ(builder.depth(), 0u);
    bool deeper = true;
    while (deeper && builder.depth() < 3) {
      const uint32_t before = builder.depth();
      std::vector<double> shares;
      deeper =
          builder.Deepen(cancel, [&](double share) { shares.push_back(share); })
              .value();
      EXPECT_EQ(builder.depth(), before + deeper);
      EXPECT_TRUE(std::ranges::is_sorted(shares));
      EXPECT_LE(shares.back(), 1);
      ExpectSoundTree(solved.canonical.mesh, solved.adjacency, builder.tree(),
                      solved.canonical.report.area, false);
    }
    builder.StopAtDepth();
    ExpectSoundTree(solved.canonical.mesh, solved.adjacency, builder.tree(),
                    solved.canonical.report.area, true);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, TreeOfAnyShape,
                         ::testing::ValuesIn(AllShapes()),
                         [](const auto& info) {
                           return TestNameOf(info.param);
                         });

TEST(TreeBuilderTest, ASingleTriangleIsARootThatIsTooSmall) {
  const SolvedMesh solved = SolveMesh(SingleTriangle());
  const CancelToken cancel;
  TreeBuilder builder(solved.context(), {}, solved.canonical.report.area);
  EXPECT_FALSE(builder.Deepen(cancel, nullptr).value());
  builder.StopAtDepth();
  ASSERT_EQ(builder.tree().nodes.size(), 1u);
  const SegmentNode& root = builder.tree().nodes[0];
  EXPECT_EQ(root.stop_reason, StopReason::kTooSmall);
  EXPECT_THAT(root.faces, ElementsAre(0));
  EXPECT_THAT(root.medial_structure, ElementsAre(0, 1, 2));
  EXPECT_NEAR(root.area, std::sqrt(0.75) / 2, 1e-12);
  EXPECT_NEAR(
      (root.centroid - Eigen::Vector3d(0.5, std::sqrt(0.75) / 3, 0)).norm(), 0,
      1e-12);
}

TEST(TreeBuilderTest, CentroidsAreWeightedByArea) {
  // Two rectangles of unequal triangles: the centre is that of the surface, not
  // of the vertices.
  TriangleMesh mesh = Grid(2, 1);
  mesh.positions(4, 0) = mesh.positions(5, 0) = 10;
  const SolvedMesh solved = SolveMesh(mesh);
  const TreeBuilder builder(solved.context(), {}, solved.canonical.report.area);
  const SegmentNode& root = builder.tree().nodes[0];
  EXPECT_NEAR(root.area, 10, 1e-9);
  EXPECT_NEAR(root.centroid.x(), 5, 1e-9);
  EXPECT_NEAR(root.centroid.y(), 0.5, 1e-9);
}

TEST(TreeBuilderTest, LeavesOfTheLastLevelAreStoppedByTheDepth) {
  const SolvedMesh solved = SolveMesh(LimbCross(3), 150);
  const CancelToken cancel;
  TreeBuilder builder(solved.context(), {}, solved.canonical.report.area);
  ASSERT_TRUE(builder.Deepen(cancel, nullptr).value());
  EXPECT_EQ(builder.tree().nodes[1].stop_reason, StopReason::kNone);
  builder.StopAtDepth();
  EXPECT_EQ(builder.tree().nodes[0].stop_reason, StopReason::kNone);
  for (uint32_t id = 1; id < builder.tree().nodes.size(); ++id)
    EXPECT_EQ(builder.tree().nodes[id].stop_reason, StopReason::kDepth);
}

TEST(TreeBuilderTest, Cancelled) {
  const SolvedMesh solved = SolveMesh(LimbCross(1));
  CancelToken cancel;
  TreeBuilder builder(solved.context(), {}, solved.canonical.report.area);
  cancel.Cancel();
  EXPECT_EQ(builder.Deepen(cancel, nullptr).status().code(),
            absl::StatusCode::kCancelled);
}

// Four faces; 0 has the children 1 (a leaf) and 2, 2 has 3 and 4.
SegmentTree SmallTree() {
  SegmentTree tree;
  tree.nodes.resize(5);
  auto fill = [&](uint32_t id, uint32_t parent, uint32_t level,
                  std::vector<uint32_t> faces, std::vector<uint32_t> children) {
    SegmentNode& node = tree.nodes[id];
    node.id = id;
    node.parent = parent;
    node.level = level;
    node.faces = std::move(faces);
    node.children = std::move(children);
  };
  fill(0, kNoIndex, 0, {0, 1, 2, 3}, {1, 2});
  fill(1, 0, 1, {1, 3}, {});
  fill(2, 0, 1, {0, 2}, {3, 4});
  fill(3, 2, 2, {2}, {});
  fill(4, 2, 2, {0}, {});
  return tree;
}

TEST(SegmentTreeTest, ALevelIsACutOfTheTree) {
  const SegmentTree tree = SmallTree();
  EXPECT_THAT(tree.SegmentsAtLevel(0), ElementsAre(0));
  EXPECT_THAT(tree.SegmentsAtLevel(1), ElementsAre(1, 2));
  EXPECT_THAT(tree.SegmentsAtLevel(2), ElementsAre(1, 3, 4));
  EXPECT_THAT(tree.SegmentsAtLevel(7), ElementsAre(1, 3, 4));
  EXPECT_THAT(tree.FaceSegments(0), ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(tree.FaceSegments(1), ElementsAre(2, 1, 2, 1));
  EXPECT_THAT(tree.FaceSegments(2), ElementsAre(4, 1, 3, 1));
}

}  // namespace
}  // namespace marrow
