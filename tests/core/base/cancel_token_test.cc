#include "core/base/cancel_token.h"

#include <thread>

#include "gtest/gtest.h"

namespace marrow {
namespace {

TEST(CancelTokenTest, IsCancelledFromAnotherThreadForGood) {
  CancelToken token;
  EXPECT_FALSE(token.IsCancelled());
  EXPECT_TRUE(token.Check().ok());
  std::thread([&] { token.Cancel(); }).join();
  EXPECT_TRUE(token.IsCancelled());
  token.Cancel();
  EXPECT_EQ(token.Check().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace marrow
