#include "core/hierarchy/level_tree.h"

#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/invariants.h"
#include "tests/testing/shapes.h"
#include "tests/testing/solved_mesh.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

// A strip of four pieces, a column of squares each.
struct Strip {
  SolvedMesh solved = SolveMesh(Grid(8, 2), 10);
  std::vector<uint32_t> pieces;

  Strip() {
    for (const auto& [a, b, c] : solved.canonical.mesh.faces) {
      double x = 0;
      for (uint32_t v : {a, b, c})
        x += solved.canonical.mesh.Position(v).x() / 3;
      pieces.push_back(static_cast<uint32_t>(x / 2));
    }
  }
  SegmentTree Build(const MergeOrder& order,
                    const std::vector<double>& thresholds) const {
    SegmentTree tree =
        BuildLevelTree(solved.context(), {}, solved.canonical.report.area,
                       pieces, order, thresholds, CancelToken())
            .value();
    // As if the pieces had been found by the very same splits.
    SegmentTree splits = tree;
    for (SegmentNode& node : splits.nodes)
      node.iterations = node.children.empty() ? 0 : IterationsOf(node);
    NoteIterations(splits, solved.areas, tree);
    return tree;
  }
  static uint32_t IterationsOf(const SegmentNode& node) {
    return static_cast<uint32_t>(node.faces.size());
  }
  void ExpectSound(const SegmentTree& tree) const {
    ExpectSoundTree(solved.canonical.mesh, solved.adjacency, tree,
                    solved.canonical.report.area, true, true);
    for (const SegmentNode& node : tree.nodes)
      EXPECT_EQ(node.iterations,
                node.children.size() > 1 ? IterationsOf(node) : 0);
  }
};

std::vector<size_t> Counts(const SegmentTree& tree) {
  std::vector<size_t> counts;
  for (uint32_t level = 1; level <= 3; ++level)
    counts.push_back(tree.SegmentsAtLevel(level).size());
  return counts;
}

TEST(LevelTreeTest, LevelsAreTheCutsAtTheThresholds) {
  const Strip strip;
  const MergeOrder order{4, {{0, 1, 0.1}, {2, 3, 0.5}, {0, 2, 0.95}}};
  const SegmentTree tree = strip.Build(order, {0.9, 0.4, 0.05});
  strip.ExpectSound(tree);
  EXPECT_THAT(Counts(tree), ElementsAre(2, 3, 4));
  EXPECT_EQ(tree.nodes[0].salience, 0.95);
  EXPECT_EQ(tree.nodes[1].salience + tree.nodes[2].salience, 0.5 + 0.1);
}

TEST(LevelTreeTest, AGroupThatOnlyADeeperCutSplitsIsItsOwnChild) {
  const Strip strip;
  const MergeOrder order{4, {{0, 1, 0.1}, {0, 2, 0.95}, {0, 3, 0.96}}};
  const SegmentTree tree = strip.Build(order, {0.9, 0.5, 0.05});
  strip.ExpectSound(tree);
  EXPECT_THAT(Counts(tree), ElementsAre(3, 3, 4));
  EXPECT_THAT(tree.nodes[1].children, ElementsAre(4));
  EXPECT_EQ(tree.nodes[4].medial_structure, tree.nodes[1].medial_structure);
  EXPECT_EQ(tree.nodes[4].stop_reason, StopReason::kNone);
  EXPECT_EQ(tree.nodes[2].stop_reason, StopReason::kOneSegment);
  EXPECT_EQ(tree.nodes[5].stop_reason, StopReason::kDepth);
}

TEST(LevelTreeTest, WhatNoCutSplitsIsALeaf) {
  const Strip strip;
  const MergeOrder order{4, {{0, 1, 0.1}, {0, 2, 0.1}, {0, 3, 0.1}}};
  const SegmentTree tree = strip.Build(order, {0.9, 0.5, 0.2});
  strip.ExpectSound(tree);
  ASSERT_EQ(tree.nodes.size(), 1u);
  EXPECT_EQ(tree.nodes[0].stop_reason, StopReason::kOneSegment);
}

TEST(LevelTreeTest, StopsOnceCancelled) {
  const Strip strip;
  CancelToken cancel;
  cancel.Cancel();
  const std::vector<double> thresholds = {0.5};
  EXPECT_TRUE(absl::IsCancelled(BuildLevelTree(strip.solved.context(), {}, 16,
                                               strip.pieces, {4, {}},
                                               thresholds, cancel)
                                    .status()));
}

}  // namespace
}  // namespace marrow
