#include "core/base/error_reason.h"

#include "gtest/gtest.h"

namespace marrow {
namespace {

TEST(ErrorReasonTest, AReasonTravelsWithTheStatus) {
  const absl::Status status =
      WithReason(absl::InternalError("it failed"), kReasonSolverNotConverged);
  EXPECT_EQ(status.code(), absl::StatusCode::kInternal);
  EXPECT_EQ(status.message(), "it failed");
  EXPECT_EQ(ReasonOf(status), "SOLVER_NOT_CONVERGED");
  EXPECT_EQ(FieldOf(status), "");
}

TEST(ErrorReasonTest, AStatusWithoutReasonHasNone) {
  EXPECT_EQ(ReasonOf(absl::InternalError("x")), "");
  EXPECT_EQ(ReasonOf(absl::OkStatus()), "");
}

TEST(ErrorReasonTest, AnInvalidFieldIsNamed) {
  const absl::Status status = InvalidField("options.kappa", "is -1");
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(), "options.kappa: is -1");
  EXPECT_EQ(ReasonOf(status), "INVALID_PARAMETER");
  EXPECT_EQ(FieldOf(status), "options.kappa");
}

}  // namespace
}  // namespace marrow
