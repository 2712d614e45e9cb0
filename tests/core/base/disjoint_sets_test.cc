#include "core/base/disjoint_sets.h"

#include <random>
#include <vector>

#include "gtest/gtest.h"

namespace marrow {
namespace {

TEST(DisjointSetsTest, StartApart) {
  DisjointSets sets(3);
  for (uint32_t x = 0; x < 3; ++x) EXPECT_EQ(sets.Find(x), x);
}

TEST(DisjointSetsTest, UnionTellsWhetherTheyWereApart) {
  DisjointSets sets(4);
  EXPECT_TRUE(sets.Union(3, 2));
  EXPECT_TRUE(sets.Union(0, 3));
  EXPECT_FALSE(sets.Union(2, 0));
}

TEST(DisjointSetsTest, AgreeWithRelabelling) {
  constexpr uint32_t kSize = 60;
  std::mt19937 random(5);
  DisjointSets sets(kSize);
  std::vector<uint32_t> least(kSize);
  for (uint32_t x = 0; x < kSize; ++x) least[x] = x;
  for (int i = 0; i < 50; ++i) {
    const uint32_t a = random() % kSize, b = random() % kSize;
    const uint32_t to = std::min(least[a], least[b]);
    const uint32_t from = std::max(least[a], least[b]);
    EXPECT_EQ(sets.Union(a, b), from != to);
    for (uint32_t& label : least)
      if (label == from) label = to;
    for (uint32_t x = 0; x < kSize; ++x) ASSERT_EQ(sets.Find(x), least[x]);
  }
}

// Every union hangs the root of a long chain below a lesser one: without
// shortened paths this takes 10^10 steps.
TEST(DisjointSetsTest, LongChainsStayQuick) {
  constexpr uint32_t kSize = 200'000;
  DisjointSets sets(kSize);
  for (uint32_t x = kSize - 1; x > 0; --x) sets.Union(x - 1, x);
  for (uint32_t x = 0; x < kSize; ++x) ASSERT_EQ(sets.Find(x), 0u);
}

}  // namespace
}  // namespace marrow
