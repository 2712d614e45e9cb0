#include "client/command/explain.h"

#include <string_view>

#include "absl/strings/str_cat.h"
#include "client/command/exit_code.h"
#include "core/base/error_reason.h"

namespace marrow::client {
namespace {

// options.eigen_pairs -> --pairs; empty for a field that no option sets.
std::string OptionOf(const std::string& field) {
  for (const char* list : {"closed", "open"}) {
    if (field.starts_with(absl::StrCat("cut.", list))) {
      return absl::StrCat("--", list);
    }
  }
  if (field.starts_with("cut.")) return "--cut";
  const std::string name = field.substr(field.rfind('.') + 1);
  if (name == "eigen_pairs") return "--pairs";
  for (const char* known :
       {"kappa", "delta", "epsilon", "tolerance", "levels"}) {
    if (name == known) return absl::StrCat("--", name);
  }
  return "";
}

// Whether the field is one node of the tree, as cut.open[1]: which there are
// depends on the mesh.
bool IsNode(const std::string& field) {
  return field.starts_with("cut.") && field.ends_with("]");
}

// How Client::Connect() begins.
constexpr char kCannotReach[] = "cannot reach";

bool IsUnreachable(const absl::Status& status) {
  return absl::IsUnavailable(status) && ReasonOf(status).empty();
}

}  // namespace

std::string Explain(const absl::Status& status) {
  std::string message(status.message());
  const std::string field = FieldOf(status);
  const std::string option = OptionOf(field);
  if (!option.empty() && message.starts_with(field)) {
    message.replace(0, field.size(), option);
    // "--kappa: is -1" reads better without the colon.
    if (message.substr(option.size()).starts_with(": is ")) {
      message.erase(option.size(), 1);
    }
    return message;
  }
  if (IsUnreachable(status) && !message.starts_with(kCannotReach)) {
    return absl::StrCat("the server was lost (", message,
                        "): see whether it still runs, and try again");
  }
  if (ReasonOf(status) == kReasonNotCached) {
    return "the server does not have it (any more) with these options: run "
           "marrow segment with them and with --cut";
  }
  if (absl::IsDeadlineExceeded(status)) {
    return absl::StrCat("not done in time (", message,
                        "): give it more with --timeout");
  }
  return message;
}

std::string ExplainFor(const std::string& file, const absl::Status& status) {
  std::string message = Explain(status);
  const bool about_all = ConcernsAllFiles(status);
  if (about_all || message.starts_with(file)) return message;
  return absl::StrCat(file, ": ", message);
}

int ExitCodeOf(const absl::Status& status) {
  if (status.ok()) return kExitOk;
  if (IsUnreachable(status)) return kExitUnreachable;
  const std::string field = FieldOf(status);
  return OptionOf(field).empty() || IsNode(field) ? kExitFailed : kExitUsage;
}

bool ConcernsAllFiles(const absl::Status& status) {
  return ExitCodeOf(status) > kExitFailed;
}

nlohmann::json ErrorJson(const absl::Status& status) {
  nlohmann::json result = {{"event", "error"},
                           {"code", absl::StatusCodeToString(status.code())},
                           {"message", Explain(status)}};
  if (const std::string reason = ReasonOf(status); !reason.empty()) {
    result["reason"] = reason;
  }
  if (const std::string field = FieldOf(status); !field.empty()) {
    result["field"] = field;
  }
  return result;
}

}  // namespace marrow::client
