#include "core/boundaries/pair_order.h"

#include <vector>

#include "absl/synchronization/mutex.h"
#include "absl/synchronization/notification.h"
#include "gtest/gtest.h"

namespace marrow {
namespace {

// Every two of so many pieces.
std::vector<PiecePair> AllPairs(uint32_t pieces) {
  std::vector<PiecePair> pairs;
  for (uint32_t a = 0; a < pieces; ++a)
    for (uint32_t b = a + 1; b < pieces; ++b) pairs.push_back({a, b});
  return pairs;
}

// A piece's number depends on the order of what was done to it.
TEST(ForPairsTest, IsAsIfOnePairCameAfterTheOther) {
  const std::vector<PiecePair> pairs = AllPairs(12);
  const auto numbers = [&](int threads) {
    std::vector<uint64_t> number(12, 1);
    Team team(threads);
    ForPairs(team, pairs, [&](int, const PiecePair& pair) {
      number[pair.first] = 31 * number[pair.first] + number[pair.second];
      number[pair.second] = 37 * number[pair.second] + number[pair.first];
    });
    return number;
  };
  const std::vector<uint64_t> one = numbers(1);
  for (int threads : {2, 3, 8}) EXPECT_EQ(numbers(threads), one) << threads;
}

TEST(ForPairsTest, GivesNoWorkerTwoPairsAtATime) {
  Team team(4);
  std::vector<int> at_work(4, 0);
  absl::Mutex mu;
  ForPairs(team, AllPairs(9), [&](int worker, const PiecePair&) {
    {
      absl::MutexLock lock(&mu);
      EXPECT_EQ(++at_work[worker], 1);
    }
    absl::MutexLock lock(&mu);
    --at_work[worker];
  });
}

// The first of them waits for the second.
TEST(ForPairsTest, DoesPairsApartAtOnce) {
  Team team(2);
  absl::Notification second;
  const std::vector<PiecePair> pairs = {{0, 1}, {2, 3}};
  ForPairs(team, pairs, [&](int, const PiecePair& pair) {
    if (pair.first == 2) return second.Notify();
    second.WaitForNotification();
  });
}

TEST(ForPairsTest, OfNoPairsIsNothing) {
  Team team(2);
  ForPairs(team, {}, [](int, const PiecePair&) { FAIL(); });
}

}  // namespace
}  // namespace marrow
