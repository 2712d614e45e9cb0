#include "core/hierarchy/cut.h"

#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "core/base/error_reason.h"
#include "core/boundaries/calibration.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

// A tree over faces alone: face f is of piece f.
class TreeMaker {
 public:
  explicit TreeMaker(uint32_t num_faces) {
    SegmentNode& root = tree_.nodes.emplace_back();
    root.faces.resize(num_faces);
    std::iota(root.faces.begin(), root.faces.end(), 0u);
    root.area = num_faces;
  }
  uint32_t Add(uint32_t parent, std::vector<uint32_t> faces) {
    SegmentNode node;
    node.id = static_cast<uint32_t>(tree_.nodes.size());
    node.parent = parent;
    node.level = tree_.nodes[parent].level + 1;
    node.area = static_cast<double>(faces.size());
    node.faces = std::move(faces);
    tree_.nodes[parent].children.push_back(node.id);
    tree_.nodes.push_back(std::move(node));
    return tree_.nodes.back().id;
  }
  const SegmentTree& tree() const { return tree_; }

 private:
  SegmentTree tree_;
};

// Eight pieces: two equal pairs of limbs, 4-5 and 6-7, on the body 0-1-2-3.
// Levels at 0.9, 0.5 and 0.2.
const std::vector<double> kThresholds = {0.9, 0.5, 0.2};
const MergeOrder kOrder{8,
                        {{0, 1, 0.1},
                         {2, 3, 0.3},
                         {4, 5, 0.4},
                         {6, 7, 0.4},
                         {0, 2, 0.6},
                         {0, 4, 0.92},
                         {0, 6, 0.95}}};

// The nodes of that tree: 0 the root; of level 1 the body 1, limbs 2 and 3; of
// level 2 the body's halves 4 and 5, limbs 6 and 7 whole again; of level 3 what
// those are split into, from 8 on. The half 4 is a leaf.
SegmentTree MergedTree() {
  TreeMaker maker(8);
  maker.Add(0, {0, 1, 2, 3});
  maker.Add(0, {4, 5});
  maker.Add(0, {6, 7});
  maker.Add(1, {0, 1});
  maker.Add(1, {2, 3});
  maker.Add(2, {4, 5});
  maker.Add(3, {6, 7});
  maker.Add(5, {2});
  maker.Add(5, {3});
  maker.Add(6, {4});
  maker.Add(6, {5});
  maker.Add(7, {6});
  maker.Add(7, {7});
  return maker.tree();
}

std::vector<uint32_t> OnePieceAFace(uint32_t count) {
  std::vector<uint32_t> pieces(count);
  std::iota(pieces.begin(), pieces.end(), 0u);
  return pieces;
}

class MergedCutTest : public ::testing::Test {
 protected:
  TreeCut Apply(const CutSpec& spec) const { return *cutter_.Apply(spec); }
  std::string ErrorOf(const CutSpec& spec) const {
    const absl::Status status = cutter_.Apply(spec).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(std::string(status.message()),
                ::testing::StartsWith(FieldOf(status)));
    return std::string(status.message());
  }

  const SegmentTree tree_ = MergedTree();
  const TreeCutter cutter_{tree_, OnePieceAFace(8), kOrder, kThresholds};
};

std::vector<uint32_t> Ids(const TreeCut& cut) {
  std::vector<uint32_t> ids;
  for (const TreeCut::Segment& segment : cut.segments)
    ids.push_back(segment.id);
  return ids;
}

// The pieces of each segment.
std::vector<std::set<uint32_t>> Groups(const TreeCut& cut) {
  std::vector<std::set<uint32_t>> groups(cut.segments.size());
  for (uint32_t p = 0; p < cut.segment_of_piece.size(); ++p)
    groups[cut.segment_of_piece[p]].insert(p);
  return groups;
}

// Whether every segment of `fine` lies in one of `coarse`.
bool Refines(const TreeCut& fine, const TreeCut& coarse) {
  std::map<uint32_t, uint32_t> into;
  for (size_t p = 0; p < fine.segment_of_piece.size(); ++p)
    if (into.emplace(fine.segment_of_piece[p], coarse.segment_of_piece[p])
            .first->second != coarse.segment_of_piece[p])
      return false;
  return true;
}

TEST_F(MergedCutTest, LevelsAreTheTreesOwn) {
  EXPECT_THAT(Ids(Apply(CutSpec::AtLevel(1))), ElementsAre(1, 2, 3));
  EXPECT_THAT(Ids(Apply(CutSpec::AtLevel(2))), ElementsAre(4, 5, 6, 7));
  EXPECT_THAT(Ids(Apply(CutSpec::AtLevel(3))),
              ElementsAre(4, 8, 9, 10, 11, 12, 13));
  EXPECT_EQ(Ids(Apply(CutSpec::AtLevel(8))), Ids(Apply(CutSpec::AtLevel(3))));
  EXPECT_EQ(Apply(CutSpec::AtLevel(2)).salience, 0.5);
  EXPECT_EQ(Apply(CutSpec::AtLevel(8)).salience, 0.2);
}

TEST_F(MergedCutTest, TheSalienceOfALevelGivesThatLevel) {
  for (uint32_t level = 1; level <= 3; ++level) {
    const TreeCut cut = Apply(CutSpec::AtSalience(kThresholds[level - 1]));
    EXPECT_EQ(Ids(cut), Ids(Apply(CutSpec::AtLevel(level))));
    EXPECT_EQ(Groups(cut), Groups(Apply(CutSpec::AtLevel(level))));
    EXPECT_EQ(cut.salience, kThresholds[level - 1]);
  }
}

TEST_F(MergedCutTest, TheAutomaticCutIsAtItsSalience) {
  const TreeCut cut = Apply({});
  EXPECT_EQ(cut.salience, kAutomaticSalience);
  EXPECT_EQ(Ids(cut), Ids(Apply(CutSpec::AtSalience(kAutomaticSalience))));
}

TEST_F(MergedCutTest, WhatIsNoNodeHasANewIdUnderTheNodeThatHoldsIt) {
  // All merged but the limb 6-7; and all pieces apart.
  const TreeCut coarse = Apply(CutSpec::AtSalience(0.93));
  EXPECT_THAT(Ids(coarse), ElementsAre(3, 14));
  EXPECT_EQ(coarse.segments[1].parent, 0u);
  EXPECT_EQ(coarse.segments[1].level, 1u);
  EXPECT_EQ(coarse.segments[1].salience, 0.92);
  EXPECT_THAT(Groups(coarse),
              ElementsAre(std::set<uint32_t>{6, 7},
                          std::set<uint32_t>{0, 1, 2, 3, 4, 5}));
  const TreeCut finest = Apply(CutSpec::AtSalience(0));
  EXPECT_THAT(Ids(finest), ElementsAre(8, 9, 10, 11, 12, 13, 14, 15));
  EXPECT_EQ(finest.segments[6].parent, 4u);
  EXPECT_EQ(finest.segments[6].level, 3u);
  EXPECT_EQ(finest.segments[6].salience, 0);
}

TEST_F(MergedCutTest, ByNumberThereAreAtMostSoManyAndEqualLimbsAreAlike) {
  for (uint32_t n = 1; n <= 50; ++n)
    EXPECT_LE(Apply(CutSpec::Into(n)).segments.size(), n);
  const std::vector<size_t> counts = {1, 2, 3, 4, 4, 6, 7, 8, 8};
  for (uint32_t n = 1; n <= counts.size(); ++n)
    EXPECT_EQ(Apply(CutSpec::Into(n)).segments.size(), counts[n - 1]) << n;
  EXPECT_EQ(Apply(CutSpec::Into(5)).salience, 0.6);
  EXPECT_EQ(Apply(CutSpec::Into(6)).salience, 0.4);
  EXPECT_EQ(Apply(CutSpec::Into(1)).salience, 1);
  EXPECT_THAT(Ids(Apply(CutSpec::Into(1))), ElementsAre(0));
}

TEST_F(MergedCutTest, MoreSegmentsRefineFewer) {
  for (uint32_t n = 1; n < 9; ++n)
    EXPECT_TRUE(Refines(Apply(CutSpec::Into(n + 1)), Apply(CutSpec::Into(n))))
        << n;
  for (double salience = 0; salience < 1; salience += 0.05)
    EXPECT_TRUE(Refines(Apply(CutSpec::AtSalience(salience)),
                        Apply(CutSpec::AtSalience(salience + 0.05))));
}

TEST_F(MergedCutTest, AClosedNodeIsNeverSplit) {
  CutSpec spec = CutSpec::AtSalience(0);
  spec.closed = {1, 6};
  EXPECT_THAT(Groups(Apply(spec)),
              UnorderedElementsAre(
                  std::set<uint32_t>{0, 1, 2, 3}, std::set<uint32_t>{4, 5},
                  std::set<uint32_t>{6}, std::set<uint32_t>{7}));
  // A coarser cut leaves it inside what holds it.
  spec = CutSpec::Into(1);
  spec.closed = {1, 6};
  EXPECT_THAT(Ids(Apply(spec)), ElementsAre(0));
  // One in another.
  spec = CutSpec::AtLevel(3);
  spec.closed = {5, 1};
  EXPECT_THAT(Ids(Apply(spec)), ElementsAre(1, 10, 11, 12, 13));
}

TEST_F(MergedCutTest, AnOpenNodeIsSplitAndSoIsWhatIsAboveIt) {
  CutSpec spec = CutSpec::Into(1);
  spec.open = {1};
  EXPECT_THAT(Ids(Apply(spec)), ElementsAre(2, 3, 4, 5));
  // What the cut splits further stays split.
  spec = CutSpec::AtLevel(3);
  spec.open = {1};
  EXPECT_EQ(Ids(Apply(spec)), Ids(Apply(CutSpec::AtLevel(3))));
  // An only child is no split yet.
  spec = CutSpec::AtLevel(1);
  spec.open = {2};
  EXPECT_THAT(Groups(Apply(spec)),
              UnorderedElementsAre(std::set<uint32_t>{0, 1, 2, 3},
                                   std::set<uint32_t>{4}, std::set<uint32_t>{5},
                                   std::set<uint32_t>{6, 7}));
}

TEST_F(MergedCutTest, OpenAndClosedGoTogetherInDifferentPlaces) {
  CutSpec spec = CutSpec::AtLevel(2);
  spec.open = {5};
  spec.closed = {4, 2};
  EXPECT_THAT(
      Groups(Apply(spec)),
      UnorderedElementsAre(std::set<uint32_t>{0, 1}, std::set<uint32_t>{2},
                           std::set<uint32_t>{3}, std::set<uint32_t>{4, 5},
                           std::set<uint32_t>{6, 7}));
  EXPECT_FALSE(Refines(Apply(CutSpec::AtLevel(2)), Apply(spec)));
  EXPECT_TRUE(Refines(Apply(spec), Apply(CutSpec::AtLevel(1))));
}

TEST_F(MergedCutTest, ErrorsNameTheNodeAndWhatIsAllowed) {
  CutSpec spec;
  spec.closed = {3, 14};
  EXPECT_THAT(ErrorOf(spec), HasSubstr("cut.closed[1]: is 14; the tree has the "
                                       "nodes 0 to 13"));
  spec = {};
  spec.open = {99};
  EXPECT_THAT(ErrorOf(spec), HasSubstr("cut.open[0]: is 99"));
  spec.open = {1, 4};
  EXPECT_THAT(ErrorOf(spec),
              HasSubstr("cut.open[1]: is 4, a segment without children"));
  spec.open = {5};
  spec.closed = {1};
  EXPECT_THAT(ErrorOf(spec), HasSubstr("cut.open[0]: is 5, inside of which 1"));
  spec.closed = {5};
  EXPECT_THAT(ErrorOf(spec), HasSubstr("cut.open[0]: is 5, which is to be"));
}

// Two bodies, of which the first is split at level 1 and the second is a node.
TEST(CutOfBodiesTest, BodiesStayApart) {
  TreeMaker maker(4);
  maker.Add(0, {0});
  maker.Add(0, {1});
  maker.Add(0, {2, 3});
  const MergeOrder order{4, {{2, 3, 0.3}, {0, 1, 0.95}}};
  const TreeCutter cutter(maker.tree(), OnePieceAFace(4), order, {0.9});
  const TreeCut two = *cutter.Apply(CutSpec::Into(1));
  EXPECT_THAT(Ids(two), ElementsAre(3, 4));
  EXPECT_EQ(two.segments[1].parent, 0u);
  EXPECT_THAT(Ids(*cutter.Apply(CutSpec::AtSalience(1))), ElementsAre(3, 4));
  EXPECT_THAT(Ids(*cutter.Apply(CutSpec::Into(3))), ElementsAre(1, 2, 3));
  CutSpec whole;
  whole.closed = {0};
  EXPECT_THAT(Ids(*cutter.Apply(whole)), ElementsAre(0));
}

// The paper's tree: 12 faces; 1 of 6, 2 of 4, 3 of 2; 1 into 4, 5; 2 into 6, 7.
SegmentTree PaperTree() {
  TreeMaker maker(12);
  maker.Add(0, {0, 1, 2, 3, 4, 5});
  maker.Add(0, {6, 7, 8, 9});
  maker.Add(0, {10, 11});
  maker.Add(1, {0, 1, 2});
  maker.Add(1, {3, 4, 5});
  maker.Add(2, {6, 7, 8});
  maker.Add(2, {9});
  maker.Add(4, {0, 1});
  maker.Add(4, {2});
  return maker.tree();
}

TEST(PaperCutTest, LevelsAndTheAutomaticCutAreTheTreesOwn) {
  const SegmentTree tree = PaperTree();
  const TreeCutter cutter(tree, false);
  for (uint32_t level = 1; level <= 8; ++level)
    EXPECT_EQ(Ids(*cutter.Apply(CutSpec::AtLevel(level))),
              tree.SegmentsAtLevel(level));
  EXPECT_EQ(Ids(*cutter.Apply({})), tree.SegmentsAtLevel(2));
  EXPECT_EQ(cutter.Apply({})->salience, 0);
}

TEST(PaperCutTest, ByNumberTheLargestIsSplitFirst) {
  const SegmentTree tree = PaperTree();
  const TreeCutter cutter(tree, false);
  EXPECT_THAT(Ids(*cutter.Apply(CutSpec::Into(2))), ElementsAre(0));
  EXPECT_THAT(Ids(*cutter.Apply(CutSpec::Into(3))), ElementsAre(1, 2, 3));
  EXPECT_THAT(Ids(*cutter.Apply(CutSpec::Into(4))), ElementsAre(2, 3, 4, 5));
  EXPECT_THAT(Ids(*cutter.Apply(CutSpec::Into(5))), ElementsAre(3, 4, 5, 6, 7));
  EXPECT_THAT(Ids(*cutter.Apply(CutSpec::Into(50))),
              ElementsAre(3, 5, 6, 7, 8, 9));
  for (uint32_t n = 1; n < 9; ++n)
    EXPECT_TRUE(Refines(*cutter.Apply(CutSpec::Into(n + 1)),
                        *cutter.Apply(CutSpec::Into(n))));
  // Where the root's children are bodies.
  EXPECT_THAT(Ids(*TreeCutter(tree, true).Apply(CutSpec::Into(1))),
              ElementsAre(1, 2, 3));
}

TEST(PaperCutTest, NodesAreHeldOpenAndClosed) {
  const SegmentTree tree = PaperTree();
  const TreeCutter cutter(tree, false);
  CutSpec spec = CutSpec::AtLevel(1);
  spec.open = {4};
  EXPECT_THAT(Ids(*cutter.Apply(spec)), ElementsAre(2, 3, 5, 8, 9));
  spec = CutSpec::AtLevel(3);
  spec.closed = {1};
  EXPECT_THAT(Ids(*cutter.Apply(spec)), ElementsAre(1, 3, 6, 7));
}

}  // namespace
}  // namespace marrow
