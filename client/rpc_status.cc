#include "client/rpc_status.h"

#include <string>

#include "absl/strings/string_view.h"
#include "core/base/error_reason.h"
#include "marrow/v1/error_details.pb.h"

namespace marrow::client {
namespace {

// The server's Any has google.rpc's type URLs, which our message names do not
// match, so Any::UnpackTo would refuse.
template <typename Message>
bool Unpack(const google::protobuf::Any& any, const char* name,
            Message& message) {
  const std::string& url = any.type_url();
  return url.substr(url.rfind('/') + 1) == name &&
         message.ParseFromString(any.value());
}

absl::Status WithDetails(absl::Status status, const v1::RpcStatus& details) {
  std::string reason;
  std::string field;
  std::string description;
  for (const google::protobuf::Any& any : details.details()) {
    v1::ErrorInfo info;
    if (Unpack(any, "google.rpc.ErrorInfo", info)) reason = info.reason();
    v1::BadRequest bad;
    if (Unpack(any, "google.rpc.BadRequest", bad) &&
        bad.field_violations_size() > 0) {
      field = bad.field_violations(0).field();
      description = bad.field_violations(0).description();
    }
  }
  // Some servers repeat the field before the description.
  const std::string prefix = field + ": ";
  if (description.starts_with(prefix)) description.erase(0, prefix.size());
  if (!field.empty() && status.code() == absl::StatusCode::kInvalidArgument) {
    status = InvalidField(field, description);
  }
  return reason.empty() ? status : WithReason(std::move(status), reason);
}

}  // namespace

absl::Status FromRpcStatus(const grpc::Status& status) {
  if (status.ok()) return absl::OkStatus();
  absl::Status result(static_cast<absl::StatusCode>(status.error_code()),
                      status.error_message());
  v1::RpcStatus details;
  if (!details.ParseFromString(status.error_details())) return result;
  return WithDetails(std::move(result), details);
}

}  // namespace marrow::client
