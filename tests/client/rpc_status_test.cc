#include "client/rpc_status.h"

#include <gtest/gtest.h>

#include "core/base/error_reason.h"
#include "marrow/v1/error_details.pb.h"

namespace marrow::client {
namespace {

template <typename Message>
void AddDetail(v1::RpcStatus& status, const std::string& name,
               const Message& message) {
  google::protobuf::Any& any = *status.add_details();
  any.set_type_url("type.googleapis.com/google.rpc." + name);
  any.set_value(message.SerializeAsString());
}

TEST(RpcStatusTest, KeepsCodeAndMessage) {
  EXPECT_TRUE(FromRpcStatus(grpc::Status::OK).ok());
  const absl::Status status =
      FromRpcStatus({grpc::StatusCode::UNAVAILABLE, "gone"});
  EXPECT_EQ(status, absl::UnavailableError("gone"));
}

TEST(RpcStatusTest, ReadsReasonAndField) {
  v1::RpcStatus details;
  v1::ErrorInfo info;
  info.set_reason("INVALID_PARAMETER");
  AddDetail(details, "ErrorInfo", info);
  v1::BadRequest bad;
  bad.add_field_violations()->set_field("options.kappa");
  bad.mutable_field_violations(0)->set_description("is -1");
  AddDetail(details, "BadRequest", bad);
  const absl::Status status =
      FromRpcStatus({grpc::StatusCode::INVALID_ARGUMENT, "bad request",
                     details.SerializeAsString()});
  EXPECT_EQ(ReasonOf(status), "INVALID_PARAMETER");
  EXPECT_EQ(FieldOf(status), "options.kappa");
  EXPECT_EQ(std::string(status.message()), "options.kappa: is -1");
}

TEST(RpcStatusTest, DetailsThatDoNotParseAreLeftOut) {
  v1::RpcStatus details;
  details.add_details()->set_type_url(
      "type.googleapis.com/google.rpc.ErrorInfo");
  details.mutable_details(0)->set_value("\xFF\xFF\xFF");
  for (const std::string& bytes :
       {std::string("\xFF\x01garbage"), details.SerializeAsString()}) {
    const absl::Status status =
        FromRpcStatus({grpc::StatusCode::INTERNAL, "oops", bytes});
    EXPECT_EQ(status, absl::InternalError("oops"));
  }
}

}  // namespace
}  // namespace marrow::client
