#include <cstdint>

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

}  // namespace
}  // namespace marrow
