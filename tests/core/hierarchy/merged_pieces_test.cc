#include "core/hierarchy/merged_pieces.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

// Faces 0, 2, 5 and 1, 3 are bodies; 4 follows 3.
TEST(MergedPiecesTest, NumbersBodyByBodyAndMergesTheWeakestFirst) {
  Bodies bodies;
  bodies.bodies.resize(2);
  bodies.bodies[0].faces = {0, 2, 5};
  bodies.bodies[1].faces = {1, 3};
  bodies.anchors = {0, 1, 2, 3, 3, 5};
  std::vector<MergeTree> trees(2);
  trees[0].piece_of_face = {1, 0, 2};
  trees[0].order = {3, {{0, 1, 0.2}, {0, 2, 0.5}}};
  trees[1].piece_of_face = {0, 1};
  trees[1].order = {2, {{0, 1, 0.2}}};
  const MergedPieces joined = JoinPieces(bodies, trees);
  EXPECT_THAT(joined.piece_of_face, ElementsAre(1, 3, 0, 4, 4, 2));
  EXPECT_EQ(joined.order.num_pieces, 5u);
  ASSERT_EQ(joined.order.merges.size(), 3u);
  EXPECT_EQ(joined.order.merges[0].b, 1u);
  EXPECT_EQ(joined.order.merges[1].a, 3u);
  EXPECT_EQ(joined.order.merges[1].b, 4u);
  EXPECT_EQ(joined.order.merges[2].salience, 0.5);
  EXPECT_THAT(joined.order.CutAt(1), ElementsAre(0, 0, 0, 3, 3));
}

}  // namespace
}  // namespace marrow
