// What `marrow segment` tells while it works on several files at once.
#ifndef MARROW_CLIENT_COMMAND_REPORTER_H_
#define MARROW_CLIENT_COMMAND_REPORTER_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "client/command/progress_bar.h"
#include "marrow/v1/segmentation_service.pb.h"

namespace marrow::client {

struct ReporterOptions {
  bool json = false;   // events as lines of JSON on standard output
  bool quiet = false;  // nothing but failures
};

// For a person: a line a file on standard output, in the order of the files,
// failures on standard error, and a summary where there are several files. As
// JSON: a line an event, as soon as it happens. Thread safe.
class Reporter {
 public:
  Reporter(const ReporterOptions& options, std::vector<std::string> files);

  // A call's event, for the file of this index.
  void Event(size_t file, const v1::SegmentEvent& event);
  // A warning of the client's own, for a person.
  void Warn(size_t file, const std::string& warning);
  // The file is done. `line` is for a person; `details` for JSON.
  void Succeeded(size_t file, std::string line, nlohmann::json details);
  void Failed(size_t file, const absl::Status& status);
  // After the last file. Files that nothing was said of were skipped.
  void Finish(absl::Duration elapsed);

  size_t failed() const;

 private:
  struct File {
    std::string name;
    double fraction = 0;
    std::string stage = "reading";
    std::vector<std::string> warnings;
    bool done = false;
    bool ok = false;
    std::string line;
  };

  void Print(const nlohmann::json& event) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Done(size_t file, bool ok, std::string line)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void ShowProgress(size_t file) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const ReporterOptions options_;
  mutable absl::Mutex mutex_;
  std::vector<File> files_ ABSL_GUARDED_BY(mutex_);
  size_t next_ ABSL_GUARDED_BY(mutex_) = 0;  // the first not told of yet
  size_t succeeded_ ABSL_GUARDED_BY(mutex_) = 0;
  size_t failed_ ABSL_GUARDED_BY(mutex_) = 0;
  ProgressBar bar_ ABSL_GUARDED_BY(mutex_);
};

// One line on standard output; bytes that are not UTF-8 become U+FFFD.
void PrintJsonLine(const nlohmann::json& value);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_REPORTER_H_
