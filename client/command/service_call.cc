#include "client/command/service_call.h"

#include <utility>

#include "absl/strings/str_format.h"
#include "client/command/exit_code.h"
#include "client/command/explain.h"
#include "client/command/reporter.h"
#include "client/command/staging_folder.h"
#include "core/base/status_macros.h"

namespace marrow::client {

ServiceCall::ServiceCall(const ServiceArguments& arguments)
    : arguments_(arguments),
      interrupt_(
          [this] {
            absl::MutexLock lock(&mutex_);
            if (cancellable_ != nullptr) cancellable_->Cancel();
          },
          [] { AbandonStaging(absl::Seconds(1)); }) {}

ServiceCall::~ServiceCall() {
  absl::MutexLock lock(&mutex_);
  cancellable_ = nullptr;
  // A factorisation of millions of entries may take seconds to notice that it
  // is cancelled; who pressed Ctrl-C need not wait for it.
  if (interrupted()) (void)connection_.release();
}

absl::Status ServiceCall::Connect(absl::Time deadline) {
  MARROW_ASSIGN_OR_RETURN(
      connection_,
      client::Connect({.server = arguments_.server,
                       .threads = static_cast<int>(arguments_.threads),
                       .deadline = deadline}));
  absl::MutexLock lock(&mutex_);
  cancellable_ = &connection_->client();
  if (interrupted()) cancellable_->Cancel();
  return absl::OkStatus();
}

int ServiceCall::ExitCode(int otherwise) const {
  return interrupted() ? kExitSignal + interrupt_.signal() : otherwise;
}

absl::StatusOr<Input> LoadInput(const std::string& path, uint32_t quantize,
                                absl::Time deadline) {
  EncodeOptions options;
  options.quantization_bits = static_cast<int>(quantize);
  MARROW_ASSIGN_OR_RETURN(
      MeshPayload loaded,
      LoadMeshPayload(path, options, MeshLimits(), deadline));
  Input input;
  input.mesh = std::move(loaded.mesh);
  input.order = std::move(loaded.encoded.order);
  input.payload = {.draco = std::move(loaded.encoded.bytes),
                   .num_faces = input.order.NumDecodedFaces(),
                   .num_points = input.order.NumDecodedPoints(),
                   .num_unused_vertices = input.order.NumUnusedVertices()};
  if (loaded.sent_as_it_is && quantize > 0) {
    input.warning =
        "--quantize has no effect on a Draco file, which is sent as it is";
  }
  return input;
}

void TellWarning(const ServiceArguments& arguments, const std::string& file,
                 const Input& input) {
  if (arguments.quiet || input.warning.empty()) return;
  absl::FPrintF(stderr, "marrow: %s: warning: %s\n", file, input.warning);
}

// Of the method's options, kappa alone is heeded by one method and not by the
// other.
void WarnOfIdleOptions(const ServiceArguments& arguments,
                       const MethodArguments& method) {
  if (arguments.quiet || !method.kappa || method.method == v1::METHOD_PAPER)
    return;
  absl::FPrintF(stderr,
                "marrow: warning: --kappa has no effect with --method merge\n");
}

int TellFailure(const std::string& file, const absl::Status& status,
                bool json) {
  if (json) {
    nlohmann::json event = ErrorJson(status);
    event["file"] = file;
    PrintJsonLine(event);
  }
  absl::FPrintF(stderr, "marrow: %s\n", ExplainFor(file, status));
  return ExitCodeOf(status);
}

}  // namespace marrow::client
