#include "server/status.h"

#include <google/protobuf/any.pb.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/error_reason.h"
#include "marrow/v1/error_details.pb.h"

namespace marrow {
namespace {

constexpr char kPrefix[] = "type.googleapis.com/google.rpc.";

v1::RpcStatus DetailsOf(const grpc::Status& status) {
  v1::RpcStatus rpc;
  EXPECT_TRUE(rpc.ParseFromString(status.error_details()));
  EXPECT_EQ(rpc.code(), static_cast<int>(status.error_code()));
  EXPECT_EQ(rpc.message(), status.error_message());
  return rpc;
}

// The only detail of that name.
template <typename Detail>
Detail Only(const v1::RpcStatus& rpc, const std::string& name) {
  Detail detail;
  int found = 0;
  for (const google::protobuf::Any& any : rpc.details()) {
    if (any.type_url() != kPrefix + name) continue;
    ++found;
    EXPECT_TRUE(detail.ParseFromString(any.value()));
  }
  EXPECT_EQ(found, 1) << name;
  return detail;
}

TEST(StatusTest, OkHasNoDetails) {
  const grpc::Status status = ToGrpcStatus(absl::OkStatus());
  EXPECT_TRUE(status.ok());
  EXPECT_EQ(status.error_details(), "");
}

TEST(StatusTest, ABadFieldIsNamed) {
  const auto rpc =
      DetailsOf(ToGrpcStatus(InvalidField("options.kappa", "is -1")));
  EXPECT_EQ(rpc.details_size(), 2);
  const auto info = Only<v1::ErrorInfo>(rpc, "ErrorInfo");
  EXPECT_EQ(info.reason(), "INVALID_PARAMETER");
  EXPECT_EQ(info.domain(), "marrow");
  const auto bad = Only<v1::BadRequest>(rpc, "BadRequest");
  ASSERT_EQ(bad.field_violations_size(), 1);
  EXPECT_EQ(bad.field_violations(0).field(), "options.kappa");
  EXPECT_EQ(bad.field_violations(0).description(), "options.kappa: is -1");
}

TEST(StatusTest, AMissingMeshIsNamed) {
  Digest digest;
  digest.bytes[31] = 0xAB;
  const grpc::Status status = ToGrpcStatus(MeshMissing(digest));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  const auto rpc = DetailsOf(status);
  EXPECT_EQ(Only<v1::ErrorInfo>(rpc, "ErrorInfo").metadata().at("sha256"),
            digest.Hex());
  const auto failure =
      Only<v1::PreconditionFailure>(rpc, "PreconditionFailure");
  ASSERT_EQ(failure.violations_size(), 1);
  EXPECT_EQ(failure.violations(0).type(), "MESH_MISSING");
  EXPECT_EQ(failure.violations(0).subject(), digest.Hex());
}

TEST(StatusTest, OverloadAndDrainingSayWhenToTryAgain) {
  const absl::Status overloaded =
      WithReason(absl::UnavailableError("busy"), kReasonOverloaded);
  for (const absl::Status& status : {overloaded, Draining()}) {
    const grpc::Status grpc_status = ToGrpcStatus(status);
    EXPECT_EQ(grpc_status.error_code(), grpc::StatusCode::UNAVAILABLE);
    const auto rpc = DetailsOf(grpc_status);
    EXPECT_GT(Only<v1::RetryInfo>(rpc, "RetryInfo").retry_delay().seconds(), 0);
    EXPECT_EQ(Only<v1::ErrorInfo>(rpc, "ErrorInfo").reason(), ReasonOf(status));
  }
}

TEST(StatusTest, EveryCodeHasExactlyOneReason) {
  for (int code = 1; code <= 16; ++code) {
    const auto rpc = DetailsOf(ToGrpcStatus(
        absl::Status(static_cast<absl::StatusCode>(code), "failed")));
    EXPECT_EQ(rpc.details_size(), 1);
    EXPECT_EQ(Only<v1::ErrorInfo>(rpc, "ErrorInfo").reason(),
              absl::StatusCodeToString(static_cast<absl::StatusCode>(code)));
  }
}

TEST(StatusTest, AHostileMessageIsCutAndCleaned) {
  const grpc::Status status =
      ToGrpcStatus(absl::InternalError("\xff\n" + std::string(100'000, 'x')));
  EXPECT_LT(status.error_message().size() + status.error_details().size(),
            4096u);
  EXPECT_EQ(status.error_message().substr(0, 3), "??x");
  DetailsOf(status);
}

}  // namespace
}  // namespace marrow
