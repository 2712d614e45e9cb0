#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/command/commands.h"
#include "client/command/cut_text.h"
#include "client/command/exit_code.h"
#include "client/command/explain.h"
#include "client/command/reporter.h"
#include "client/command/result_folder.h"
#include "client/command/results.h"
#include "client/command/service_call.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

v1::SegmentRequest ToRequest(const SegmentArguments& arguments) {
  v1::SegmentRequest request;
  *request.mutable_options() = arguments.method.ToMessage();
  *request.mutable_cut() = ToMessage(arguments.cut);
  return request;
}

std::string SpectrumNote(const nlohmann::json& cache) {
  const std::string outcome = cache.value("outcome", "");
  if (outcome == "hit") return "spectrum kept";
  if (outcome == "joined") return "spectrum shared";
  return "spectrum computed";
}

// Segments the files of one command, several at a time.
class SegmentRun {
 public:
  SegmentRun(const SegmentArguments& arguments, ServiceCall& call)
      : arguments_(arguments),
        call_(call),
        reporter_(
            {.json = arguments.service.json, .quiet = arguments.service.quiet},
            arguments.files) {}

  int Run() {
    const absl::Time start = absl::Now();
    std::vector<std::thread> workers;
    for (size_t i = 0; i < NumWorkers(); ++i) {
      workers.emplace_back([this] { Work(); });
    }
    for (std::thread& worker : workers) worker.join();
    reporter_.Finish(absl::Now() - start);
    if (exit_code_ != kExitOk) return exit_code_;
    return reporter_.failed() > 0 ? kExitFailed : kExitOk;
  }

 private:
  size_t NumWorkers() const {
    const uint32_t wanted = arguments_.service.threads > 0
                                ? arguments_.service.threads
                                : std::thread::hardware_concurrency();
    return std::min<size_t>(std::clamp(wanted, 1u, kMaxFilesAtOnce),
                            arguments_.files.size());
  }

  void Work() {
    for (size_t file = next_++; file < arguments_.files.size();
         file = next_++) {
      if (call_.interrupted() || exit_code_ != kExitOk) return;
      const absl::Status status = SegmentFile(file);
      if (status.ok() || call_.interrupted()) continue;
      // What would fail for every file is told once.
      int none = kExitOk;
      if (ConcernsAllFiles(status) &&
          !exit_code_.compare_exchange_strong(none, ExitCodeOf(status))) {
        return;
      }
      reporter_.Failed(file, status);
    }
  }

  absl::Status SegmentFile(size_t file) {
    const absl::Time start = absl::Now();
    const absl::Time deadline = arguments_.service.Deadline();
    const std::string& path = arguments_.files[file];
    MARROW_ASSIGN_OR_RETURN(
        const Input input,
        LoadInput(path, arguments_.service.quantize, deadline));
    if (!input.warning.empty()) reporter_.Warn(file, input.warning);
    MARROW_ASSIGN_OR_RETURN(
        Segmentation answer,
        call_.client().Segment(input.payload, ToRequest(arguments_),
                               deadline - absl::Now(),
                               [&](const v1::SegmentEvent& event) {
                                 reporter_.Event(file, event);
                               }));
    MARROW_ASSIGN_OR_RETURN(const Segmentation segmentation,
                            InFileOrder(std::move(answer), input.order));
    MARROW_ASSIGN_OR_RETURN(
        const std::vector<ResultFile> files,
        ResultsOf(path, input.mesh, segmentation, deadline));
    if (call_.interrupted()) return absl::CancelledError("interrupted");
    MARROW_RETURN_IF_ERROR(PublishResults(arguments_.folder, StemOf(path),
                                          files, {.inputs = arguments_.files}));
    Tell(file, segmentation, files, absl::Now() - start);
    return absl::OkStatus();
  }

  absl::StatusOr<std::vector<ResultFile>> ResultsOf(
      const std::string& path, const PolygonMesh& mesh,
      const Segmentation& segmentation, absl::Time deadline) const {
    const std::string name = path.substr(path.rfind('/') + 1);
    return MakeResultFiles(name, mesh, segmentation,
                           {.parts = arguments_.parts,
                            .png = arguments_.png,
                            .deadline = deadline},
                           arguments_.cut);
  }

  void Tell(size_t file, const Segmentation& segmentation,
            const std::vector<ResultFile>& files, absl::Duration elapsed) {
    const std::string prefix =
        arguments_.folder == "." ? "" : absl::StrCat(arguments_.folder, "/");
    nlohmann::json outputs = nlohmann::json::array();
    for (const ResultFile& each : files) outputs.push_back(prefix + each.name);
    const std::string line = absl::StrFormat(
        "%s: %s; %.1f s (%s) -> %s%s", arguments_.files[file],
        CountSegments(segmentation), absl::ToDoubleSeconds(elapsed),
        SpectrumNote(segmentation.cache), prefix, files[0].name);
    reporter_.Succeeded(file, line,
                        {{"timings", segmentation.timings},
                         {"cache", segmentation.cache},
                         {"outputs", outputs}});
  }

  const SegmentArguments& arguments_;
  ServiceCall& call_;
  Reporter reporter_;
  std::atomic<size_t> next_ = 0;
  std::atomic<int> exit_code_ = kExitOk;  // of a failure that ends the run
};

}  // namespace

int RunSegment(const SegmentArguments& arguments) {
  if (const absl::Status status = CheckStems(arguments.files); !status.ok()) {
    TellFailure("", status, arguments.service.json);
    return kExitUsage;
  }
  WarnOfIdleOptions(arguments.service, arguments.method);
  ServiceCall call(arguments.service);
  const auto made = PrepareFolder(arguments.folder);
  absl::Status status = made.status();
  if (status.ok()) status = call.Connect(arguments.service.Deadline());
  const int code = call.ExitCode(
      status.ok() ? SegmentRun(arguments, call).Run()
                  : TellFailure("", status, arguments.service.json));
  if (code != kExitOk && made.ok()) RemoveFolders(*made);
  return code;
}

}  // namespace marrow::client
