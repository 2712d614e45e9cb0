#include "core/base/status_macros.h"

#include <memory>

#include "gtest/gtest.h"

namespace marrow {
namespace {

absl::StatusOr<std::unique_ptr<int>> Box(int value) {
  if (value < 0) return absl::OutOfRangeError("negative");
  return std::make_unique<int>(value);
}

absl::StatusOr<int> Sum(int a, int b) {
  MARROW_ASSIGN_OR_RETURN(const std::unique_ptr<int> x, Box(a));
  std::unique_ptr<int> y;
  MARROW_ASSIGN_OR_RETURN(y, Box(b));
  return *x + *y;
}

absl::Status Check(absl::Status status, bool& went_on) {
  MARROW_RETURN_IF_ERROR(std::move(status));
  went_on = true;
  return absl::OkStatus();
}

TEST(StatusMacrosTest, AssignOrReturn) {
  EXPECT_EQ(Sum(1, 2).value(), 3);
  EXPECT_EQ(Sum(-1, 2).status(), absl::OutOfRangeError("negative"));
  EXPECT_EQ(Sum(1, -2).status(), absl::OutOfRangeError("negative"));
}

TEST(StatusMacrosTest, ReturnIfError) {
  bool went_on = false;
  EXPECT_EQ(Check(absl::AbortedError("x"), went_on), absl::AbortedError("x"));
  EXPECT_FALSE(went_on);
  EXPECT_TRUE(Check(absl::OkStatus(), went_on).ok());
  EXPECT_TRUE(went_on);
}

}  // namespace
}  // namespace marrow
