#include "core/base/error_reason.h"

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"

namespace marrow {
namespace {

constexpr char kReasonUrl[] = "marrow/reason";
constexpr char kFieldUrl[] = "marrow/field";

absl::string_view ToAbsl(std::string_view s) { return {s.data(), s.size()}; }

std::string PayloadOf(const absl::Status& status, const char* url) {
  auto payload = status.GetPayload(url);
  return payload.has_value() ? std::string(*payload) : std::string();
}

}  // namespace

absl::Status WithReason(absl::Status status, std::string_view reason) {
  status.SetPayload(kReasonUrl, absl::Cord(ToAbsl(reason)));
  return status;
}

absl::Status InvalidField(std::string_view field,
                          std::string_view description) {
  absl::Status status = absl::InvalidArgumentError(
      absl::StrCat(ToAbsl(field), ": ", ToAbsl(description)));
  status.SetPayload(kFieldUrl, absl::Cord(ToAbsl(field)));
  return WithReason(std::move(status), kReasonInvalidParameter);
}

std::string ReasonOf(const absl::Status& status) {
  return PayloadOf(status, kReasonUrl);
}

std::string FieldOf(const absl::Status& status) {
  return PayloadOf(status, kFieldUrl);
}

}  // namespace marrow
