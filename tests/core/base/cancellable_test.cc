#include "core/base/cancellable.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "gtest/gtest.h"

namespace marrow {
namespace {

constexpr uint32_t kCount = 300'000;

// Ascending, falling, all equal, few values, and mixed.
std::vector<std::vector<uint32_t>> Inputs() {
  std::vector<std::vector<uint32_t>> inputs(5, std::vector<uint32_t>(kCount));
  for (uint32_t i = 0; i < kCount; ++i) {
    inputs[0][i] = i;
    inputs[1][i] = kCount - i;
    inputs[2][i] = 7;
    inputs[3][i] = i % 3;
    inputs[4][i] = i * 2'654'435'769u;
  }
  return inputs;
}

TEST(SortUnlessCancelledTest, Sorts) {
  for (const std::vector<uint32_t>& input : Inputs()) {
    std::vector<uint32_t> expected = input, actual = input;
    std::sort(expected.begin(), expected.end(), std::greater<>());
    ASSERT_TRUE(SortUnlessCancelled(actual.begin(), actual.end(),
                                    std::greater<>(), CancelToken())
                    .ok());
    EXPECT_EQ(actual, expected);
  }
}

TEST(SortUnlessCancelledTest, StopsAndKeepsTheElements) {
  for (const std::vector<uint32_t>& input : Inputs()) {
    CancelToken cancel;
    uint64_t calls = 0;
    const auto before = [&](uint32_t a, uint32_t b) {
      if (++calls == 2 * kCount) cancel.Cancel();
      return a < b;
    };
    std::vector<uint32_t> actual = input;
    EXPECT_EQ(SortUnlessCancelled(actual.begin(), actual.end(), before, cancel)
                  .code(),
              absl::StatusCode::kCancelled);
    std::vector<uint32_t> expected = input;
    std::sort(expected.begin(), expected.end());
    std::sort(actual.begin(), actual.end());
    EXPECT_EQ(actual, expected);
  }
}

TEST(ForEachIndexTest, VisitsAllInOrder) {
  for (uint32_t count : {0u, 1u, 1u << 15, kCount}) {
    uint32_t next = 0;
    EXPECT_TRUE(ForEachIndex(count, CancelToken(), [&](uint32_t i) {
                  EXPECT_EQ(i, next++);
                }).ok());
    EXPECT_EQ(next, count);
  }
}

TEST(ForEachIndexTest, StopsSoon) {
  CancelToken cancel;
  uint32_t visited = 0;
  EXPECT_EQ(ForEachIndex(kCount, cancel,
                         [&](uint32_t i) {
                           ++visited;
                           if (i == 100) cancel.Cancel();
                         })
                .code(),
            absl::StatusCode::kCancelled);
  EXPECT_LE(visited, 1u << 15);
}

}  // namespace
}  // namespace marrow
