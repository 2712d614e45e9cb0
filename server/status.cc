#include "server/status.h"

#include <google/protobuf/any.pb.h>

#include <string>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "marrow/v1/error_details.pb.h"

namespace marrow {
namespace {

constexpr char kSubjectUrl[] = "marrow/subject";
constexpr char kTypePrefix[] = "type.googleapis.com/google.rpc.";
constexpr int kRetrySeconds = 1;

// Message and details travel in headers, which hold 8 KiB.
constexpr size_t kMaxMessageBytes = 1024;

std::string SubjectOf(const absl::Status& status) {
  auto payload = status.GetPayload(kSubjectUrl);
  return payload.has_value() ? std::string(*payload) : std::string();
}

// gRPC takes bytes of any kind, but detail messages are UTF-8 by contract.
std::string CleanMessage(const absl::Status& status) {
  std::string text(status.message().substr(0, kMaxMessageBytes));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 ||
        static_cast<unsigned char>(c) > 0x7e) {
      c = '?';
    }
  }
  return text;
}

void Pack(const google::protobuf::Message& message, v1::RpcStatus& status) {
  google::protobuf::Any* any = status.add_details();
  any->set_type_url(kTypePrefix + message.GetDescriptor()->name());
  message.SerializeToString(any->mutable_value());
}

void AddErrorInfo(const absl::Status& status, const std::string& reason,
                  v1::RpcStatus& rpc) {
  v1::ErrorInfo info;
  info.set_reason(reason);
  info.set_domain("marrow");
  if (const std::string field = FieldOf(status); !field.empty()) {
    (*info.mutable_metadata())["field"] = field;
  }
  if (const std::string subject = SubjectOf(status); !subject.empty()) {
    (*info.mutable_metadata())["sha256"] = subject;
  }
  Pack(info, rpc);
}

void AddBadRequest(const absl::Status& status, v1::RpcStatus& rpc) {
  const std::string field = FieldOf(status);
  if (field.empty()) return;
  v1::BadRequest bad_request;
  auto* violation = bad_request.add_field_violations();
  violation->set_field(field);
  violation->set_description(rpc.message());
  Pack(bad_request, rpc);
}

void AddPreconditionFailure(const absl::Status& status,
                            const std::string& reason, v1::RpcStatus& rpc) {
  if (reason != kReasonMeshMissing) return;
  v1::PreconditionFailure failure;
  auto* violation = failure.add_violations();
  violation->set_type(reason);
  violation->set_subject(SubjectOf(status));
  violation->set_description(rpc.message());
  Pack(failure, rpc);
}

void AddRetryInfo(const std::string& reason, v1::RpcStatus& rpc) {
  if (reason != kReasonOverloaded && reason != kReasonDraining) return;
  v1::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(kRetrySeconds);
  Pack(retry, rpc);
}

}  // namespace

absl::Status MeshMissing(const Digest& sha256) {
  absl::Status status = absl::FailedPreconditionError(
      absl::StrCat("the mesh ", sha256.Hex(),
                   " is not on this server; upload it with "
                   "MeshStoreService.UploadMesh and call again"));
  status.SetPayload(kSubjectUrl, absl::Cord(sha256.Hex()));
  return WithReason(status, kReasonMeshMissing);
}

absl::Status NotCached(const Digest& sha256) {
  absl::Status status = absl::NotFoundError(
      absl::StrCat("no result for the mesh ", sha256.Hex(),
                   " with these options is kept on this server; call "
                   "SegmentationService.Segment with the mesh, the options and "
                   "the cut"));
  status.SetPayload(kSubjectUrl, absl::Cord(sha256.Hex()));
  return WithReason(status, kReasonNotCached);
}

absl::Status Draining() {
  return WithReason(
      absl::UnavailableError("the server is shutting down; call another"),
      kReasonDraining);
}

grpc::Status ToGrpcStatus(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  std::string reason = ReasonOf(status);
  if (reason.empty()) reason = absl::StatusCodeToString(status.code());
  v1::RpcStatus rpc;
  rpc.set_code(static_cast<int>(status.code()));
  rpc.set_message(CleanMessage(status));
  AddErrorInfo(status, reason, rpc);
  AddBadRequest(status, rpc);
  AddPreconditionFailure(status, reason, rpc);
  AddRetryInfo(reason, rpc);
  return grpc::Status(static_cast<grpc::StatusCode>(status.code()),
                      rpc.message(), rpc.SerializeAsString());
}

}  // namespace marrow
