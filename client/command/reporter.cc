#include "client/command/reporter.h"

#include <unistd.h>

#include <cstdio>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/command/explain.h"
#include "client/message_json.h"

namespace marrow::client {
namespace {

using nlohmann::json;

// What a program is told of an event; labels are left to the files.
std::optional<json> EventJson(const v1::SegmentEvent& event) {
  switch (event.event_case()) {
    case v1::SegmentEvent::kAccepted:
      return json{
          {"event", "accepted"},
          {"job_id", event.accepted().job_id()},
          {"result", OutcomeName(event.accepted().result())},
          {"mesh_digest", HexOf(event.accepted().mesh_digest().sha256())}};
    case v1::SegmentEvent::kProgress:
      return json{{"event", "progress"},
                  {"stage", StageName(event.progress().stage())},
                  {"fraction", event.progress().fraction()}};
    case v1::SegmentEvent::kMeshReport:
      return json{{"event", "mesh_report"},
                  {"report", ReportJson(event.mesh_report())}};
    case v1::SegmentEvent::kLevel:
      return json{{"event", "level"},
                  {"level", event.level().level()},
                  {"segments", event.level().segments_size()}};
    case v1::SegmentEvent::kCut:
      return json{{"event", "cut"},
                  {"salience", event.cut().salience()},
                  {"segments", event.cut().segments_size()}};
    case v1::SegmentEvent::kSkeleton:
      return json{{"event", "skeleton"},
                  {"level", event.skeleton().level()},
                  {"joints", event.skeleton().joints_size()}};
    case v1::SegmentEvent::kWarning:
      return json{{"event", "warning"},
                  {"code", event.warning().code()},
                  {"message", event.warning().message()}};
    default:
      return std::nullopt;
  }
}

}  // namespace

void PrintJsonLine(const json& value) {
  const std::string line =
      value.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  std::fwrite(line.data(), 1, line.size(), stdout);
  std::fflush(stdout);
}

Reporter::Reporter(const ReporterOptions& options,
                   std::vector<std::string> files)
    // On one terminal the lines of JSON would stand behind the bar.
    : options_(options),
      bar_(!options.quiet && !(options.json && isatty(STDOUT_FILENO) == 1)) {
  for (std::string& name : files) {
    files_.emplace_back().name = std::move(name);
  }
}

void Reporter::Print(const json& event) {
  if (options_.json) PrintJsonLine(event);
}

void Reporter::Event(size_t file, const v1::SegmentEvent& event) {
  absl::MutexLock lock(&mutex_);
  File& state = files_[file];
  if (std::optional<json> line = EventJson(event); line.has_value()) {
    (*line)["file"] = state.name;
    Print(*line);
  }
  if (event.has_warning()) state.warnings.push_back(event.warning().message());
  if (event.has_progress()) {
    state.fraction = event.progress().fraction();
    state.stage = StageName(event.progress().stage());
    ShowProgress(file);
  }
}

void Reporter::Warn(size_t file, const std::string& warning) {
  absl::MutexLock lock(&mutex_);
  files_[file].warnings.push_back(warning);
}

void Reporter::Succeeded(size_t file, std::string line, json details) {
  absl::MutexLock lock(&mutex_);
  ++succeeded_;
  details["event"] = "completed";
  details["file"] = files_[file].name;
  Print(details);
  Done(file, true, std::move(line));
}

void Reporter::Failed(size_t file, const absl::Status& status) {
  absl::MutexLock lock(&mutex_);
  ++failed_;
  json event = ErrorJson(status);
  event["file"] = files_[file].name;
  Print(event);
  Done(file, false, ExplainFor(files_[file].name, status));
}

void Reporter::Done(size_t file, bool ok, std::string line) {
  files_[file].done = true;
  files_[file].ok = ok;
  files_[file].fraction = 1;
  files_[file].line = std::move(line);
  bar_.Clear();
  for (; next_ < files_.size() && files_[next_].done; ++next_) {
    const File& told = files_[next_];
    if (!options_.quiet) {
      for (const std::string& warning : told.warnings) {
        absl::FPrintF(stderr, "marrow: %s: warning: %s\n", told.name, warning);
      }
    }
    if (!told.ok) {
      absl::FPrintF(stderr, "marrow: %s\n", told.line);
    } else if (!options_.quiet && !options_.json) {
      absl::PrintF("%s\n", told.line);
      std::fflush(stdout);
    }
  }
}

void Reporter::ShowProgress(size_t file) {
  double sum = 0;
  for (const File& each : files_) sum += each.fraction;
  const std::string count = files_.size() == 1
                                ? ""
                                : absl::StrCat(succeeded_ + failed_, " of ",
                                               files_.size(), " done, ");
  // Without its folders the name leaves room for the stage.
  const std::string& path = files_[file].name;
  bar_.Show(sum / static_cast<double>(files_.size()),
            absl::StrCat(count, path.substr(path.rfind('/') + 1), ": ",
                         files_[file].stage));
}

void Reporter::Finish(absl::Duration elapsed) {
  absl::MutexLock lock(&mutex_);
  bar_.Clear();
  const size_t skipped = files_.size() - succeeded_ - failed_;
  const double seconds = absl::ToDoubleSeconds(elapsed);
  Print({{"event", "summary"},
         {"files", files_.size()},
         {"succeeded", succeeded_},
         {"failed", failed_},
         {"skipped", skipped},
         {"seconds", seconds}});
  if (files_.size() < 2 || options_.quiet || options_.json) return;
  absl::PrintF("%d files: %d segmented, %d failed", files_.size(), succeeded_,
               failed_);
  if (skipped > 0) absl::PrintF(", %d skipped", skipped);
  absl::PrintF(", %.1f s\n", seconds);
}

size_t Reporter::failed() const {
  absl::MutexLock lock(&mutex_);
  return failed_;
}

}  // namespace marrow::client
