#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/command/commands.h"
#include "client/command/cut_text.h"
#include "client/command/exit_code.h"
#include "client/command/reporter.h"
#include "client/command/result_folder.h"
#include "client/command/results.h"
#include "client/command/service_call.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

// The service in this process has nothing kept: it segments.
absl::StatusOr<CutAnswer> SegmentAnew(const CutArguments& arguments,
                                      const Payload& payload,
                                      absl::Time deadline, ServiceCall& call) {
  if (!arguments.service.quiet) {
    absl::FPrintF(stderr,
                  "marrow: there is no --server that has kept the tree, so it "
                  "is made anew\n");
  }
  v1::SegmentRequest request;
  *request.mutable_options() = arguments.method.ToMessage();
  *request.mutable_cut() = ToMessage(arguments.cut);
  MARROW_ASSIGN_OR_RETURN(
      Segmentation answer,
      call.client().Segment(payload, request, deadline - absl::Now(),
                            [](const v1::SegmentEvent&) {}));
  return CutAnswer{std::move(answer.cut).value(), std::move(answer.timings),
                   std::move(answer.cache)};
}

absl::StatusOr<CutAnswer> AskForCut(const CutArguments& arguments,
                                    const Payload& payload, absl::Time deadline,
                                    ServiceCall& call) {
  if (arguments.service.server.empty()) {
    return SegmentAnew(arguments, payload, deadline, call);
  }
  v1::CutRequest request;
  *request.mutable_options() = arguments.method.ToMessage();
  *request.mutable_cut() = ToMessage(arguments.cut);
  return call.client().Cut(payload, request, deadline - absl::Now());
}

void Tell(const CutArguments& arguments, const CutAnswer& answer,
          const std::vector<ResultFile>& files) {
  const std::string prefix =
      arguments.folder == "." ? "" : absl::StrCat(arguments.folder, "/");
  if (arguments.service.json) {
    nlohmann::json outputs = nlohmann::json::array();
    for (const ResultFile& file : files) outputs.push_back(prefix + file.name);
    PrintJsonLine({{"event", "cut"},
                   {"file", arguments.file},
                   {"segments", answer.cut.segments.size()},
                   {"salience", answer.cut.salience},
                   {"timings", answer.timings},
                   {"cache", answer.cache},
                   {"outputs", outputs}});
  } else if (!arguments.service.quiet) {
    const size_t count = answer.cut.segments.size();
    absl::PrintF("%s: %d %s; %.0f ms -> %s%s\n", arguments.file, count,
                 count == 1 ? "segment" : "segments",
                 1e3 * answer.timings.value("total_seconds", 0.0), prefix,
                 files[0].name);
  }
}

absl::Status CutFile(const CutArguments& arguments, ServiceCall& call) {
  const absl::Time deadline = arguments.service.Deadline();
  MARROW_ASSIGN_OR_RETURN(
      const Input input,
      LoadInput(arguments.file, arguments.service.quantize, deadline));
  TellWarning(arguments.service, arguments.file, input);
  MARROW_RETURN_IF_ERROR(call.Connect(deadline));
  MARROW_ASSIGN_OR_RETURN(CutAnswer answer,
                          AskForCut(arguments, input.payload, deadline, call));
  MARROW_RETURN_IF_ERROR(PutInFileOrder(input.order, answer.cut));
  const std::string name = arguments.file.substr(arguments.file.rfind('/') + 1);
  MARROW_ASSIGN_OR_RETURN(const std::vector<ResultFile> files,
                          MakeCutFiles(name, input.mesh, answer,
                                       {.parts = arguments.parts,
                                        .png = arguments.png,
                                        .deadline = deadline},
                                       arguments.cut));
  if (call.interrupted()) return absl::CancelledError("interrupted");
  MARROW_ASSIGN_OR_RETURN(const std::vector<std::string> made,
                          PrepareFolder(arguments.folder));
  absl::Status published =
      PublishResults(arguments.folder, StemOf(name), files,
                     {.scope = ResultScope::kCut, .inputs = {arguments.file}});
  if (!published.ok()) {
    RemoveFolders(made);
    return published;
  }
  Tell(arguments, answer, files);
  return absl::OkStatus();
}

}  // namespace

int RunCut(const CutArguments& arguments) {
  WarnOfIdleOptions(arguments.service, arguments.method);
  ServiceCall call(arguments.service);
  const absl::Status status = CutFile(arguments, call);
  if (status.ok() || call.interrupted()) return call.ExitCode(kExitOk);
  return TellFailure(arguments.file, status, arguments.service.json);
}

}  // namespace marrow::client
