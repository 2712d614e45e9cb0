#include "core/pieces/ranked_set.h"

#include <random>
#include <set>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;

TEST(RankedSetTest, HasTheCornersOfItsFacesAndTheirPlaces) {
  std::mt19937 random(31);
  for (uint32_t offset : {0u, 63u, 64u, 1000u}) {
    std::vector<Triangle> triangles;
    for (int f = 0; f < 90; ++f)
      triangles.push_back({offset + random() % 500, offset + random() % 500,
                           offset + random() % 500});
    std::vector<uint32_t> members;
    std::set<uint32_t> expected;
    for (uint32_t f = 0; f < triangles.size(); f += 2) {
      members.push_back(f);
      expected.insert(triangles[f].begin(), triangles[f].end());
    }
    const RankedSet corners(triangles, members);
    EXPECT_THAT(corners.Members(), ElementsAreArray(expected));
    uint32_t rank = 0;
    for (uint32_t v : expected) EXPECT_EQ(corners.RankOf(v), rank++) << v;
  }
}

TEST(RankedSetTest, TakesTheEndsOfItsWords) {
  const std::vector<Triangle> triangles = {{63, 64, 127}};
  const RankedSet corners(triangles, std::vector<uint32_t>{0});
  EXPECT_THAT(corners.Members(), ElementsAre(63, 64, 127));
  EXPECT_EQ(corners.RankOf(63), 0u);
  EXPECT_EQ(corners.RankOf(64), 1u);
  EXPECT_EQ(corners.RankOf(127), 2u);
}

TEST(RankedSetTest, OfNoFacesIsEmpty) {
  EXPECT_THAT(RankedSet({}, {}).Members(), IsEmpty());
}

}  // namespace
}  // namespace marrow
