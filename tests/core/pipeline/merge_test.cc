#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/invariants.h"
#include "tests/testing/run.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

SegmentationOptions Merging(uint32_t levels = 3) {
  SegmentationOptions options;
  options.method = Method::kMerge;
  options.eigen_pairs = 60;
  options.levels = levels;
  return options;
}

class MergeOnAnyShape : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(MergeOnAnyShape, KeepsEveryPromiseUnderAnyNumbering) {
  const RecordingSink run = RunOn(GetParam().mesh, Merging());
  const Adjacency adjacency(run.mesh.mesh);
  ExpectSoundTree(run.mesh.mesh, adjacency, run.tree, run.mesh.report.area,
                  true, true);
  ASSERT_GE(run.levels.size(), 1u);
  for (const auto& level : run.levels)
    ExpectSoundSkeleton(run.mesh.mesh, adjacency, run.tree, level.level,
                        level.skeleton);
  const Renumbering renumbering = Renumber(GetParam().mesh, 5);
  ExpectSameTree(RunOn(renumbering.mesh, Merging()).tree, run.tree);
}

INSTANTIATE_TEST_SUITE_P(Shapes, MergeOnAnyShape,
                         ::testing::ValuesIn(AllShapes()),
                         [](const auto& info) {
                           return TestNameOf(info.param);
                         });

// A body and four limbs, whichever way it is cut from coarse to fine.
TEST(MergeTest, FindsTheLimbsOfACross) {
  const RecordingSink run = RunOn(LimbCross(4), Merging());
  EXPECT_THAT(run.events, ::testing::IsSupersetOf({"mesh", "level 1", "tree"}));
  EXPECT_EQ(run.tree.SegmentsAtLevel(2).size(), 5u);
}

// More limbs than two splits part from each other: the first cut the trunk.
TEST(MergeTest, FindsTheLegsOfACentipede) {
  std::set<std::array<int, 3>> cubes;
  constexpr int kPairs = 10, kReach = 4;
  for (int x = 0; x <= 3 * kPairs; ++x)
    for (int y : {0, 1})
      for (int z : {0, 1}) cubes.insert({x, y, z});
  for (int pair = 0; pair < kPairs; ++pair)
    for (int i = 1; i <= kReach; ++i)
      for (int z : {-i, 1 + i}) cubes.insert({1 + 3 * pair, 0, z});
  const TriangleMesh mesh = CubesSurface(cubes, 2);
  SegmentationOptions options = Merging();
  options.eigen_pairs = 200;
  const RecordingSink run = RunOn(mesh, options);
  ASSERT_GE(run.levels.size(), 2u);
  std::set<uint32_t> feet;
  std::map<uint32_t, std::set<uint32_t>> of_foot;  // by leg
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const Eigen::Vector3d p = mesh.Position(mesh.faces[f][0]);
    const double scale = mesh.positions.col(0).maxCoeff() / (3 * kPairs + 1);
    const double reach = std::max(-p.z() / scale, p.z() / scale - 2);
    if (reach < kReach - 1) continue;
    const auto leg = static_cast<uint32_t>(p.x() / scale / 3) * 2 + (p.z() > 0);
    of_foot[leg].insert(run.levels[1].face_labels[f]);
  }
  for (const auto& [leg, segments] : of_foot) {
    EXPECT_EQ(segments.size(), 1u) << leg;
    feet.insert(*segments.begin());
  }
  EXPECT_EQ(of_foot.size(), 2u * kPairs);
  // Two splits alone part 10 of them.
  EXPECT_GE(feet.size(), 13u);
}

TEST(MergeTest, HasNoKappaOfTheCaller) {
  SegmentationOptions other = Merging();
  other.split.kappa = 5;
  ExpectSameTree(RunOn(LimbCross(3), other).tree,
                 RunOn(LimbCross(3), Merging()).tree);
}

TEST(MergeTest, FewerLevelsAreTheFirstOfMore) {
  const RecordingSink one = RunOn(LimbCross(3), Merging(1));
  const RecordingSink all = RunOn(LimbCross(3), Merging(8));
  EXPECT_THAT(one.events, ElementsAre("mesh", "level 1", "tree"));
  EXPECT_LE(all.levels.size(), 3u);
  EXPECT_EQ(one.levels[0].face_labels, all.levels[0].face_labels);
}

TEST(MergeTest, TheAutomaticCutIsOfTheTreesNodes) {
  const TriangleMesh cross = LimbCross(3);
  for (uint32_t levels = 1; levels <= 3; ++levels) {
    const RecordingSink run = RunOn(cross, Merging(levels));
    const CutResult cut = run.segmented->Cut(CutSpec(), CancelToken()).value();
    for (const TreeCut::Segment& segment : cut.segments)
      EXPECT_LT(segment.id, run.tree.nodes.size());
  }
}

TEST(MergeTest, WhatIsSplitTookIterations) {
  const SegmentTree tree = RunOn(LimbCross(3), Merging()).tree;
  EXPECT_GT(tree.nodes[0].children.size(), 1u);
  for (const SegmentNode& node : tree.nodes)
    EXPECT_EQ(node.iterations > 0, node.children.size() > 1) << node.id;
}

}  // namespace
}  // namespace marrow
