// Hidden folders in which results wait for their place.
#ifndef MARROW_CLIENT_COMMAND_STAGING_FOLDER_H_
#define MARROW_CLIENT_COMMAND_STAGING_FOLDER_H_

#include <filesystem>
#include <memory>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"

namespace marrow::client {

// A hidden folder inside `parent`, removed with all that is in it. Errors name
// the parent and say what to do.
class StagingFolder {
 public:
  static absl::StatusOr<StagingFolder> Make(const std::string& parent);
  StagingFolder(StagingFolder&& other) noexcept;
  StagingFolder& operator=(StagingFolder&&) = delete;
  ~StagingFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  explicit StagingFolder(std::filesystem::path path);

  std::filesystem::path path_;
};

// While files move from and to staging folders: keeps AbandonStaging() from
// ending that halfway. Several may be held at once, one a thread.
class FilesMove {
 public:
  FilesMove();
  ~FilesMove();
  FilesMove(const FilesMove&) = delete;
  FilesMove& operator=(const FilesMove&) = delete;
};

// Before a process ends while others of its threads work on: lets files finish
// moving, for `patience` at most, and removes the staging folders that there
// are. No files move after that, and no staging folders are made: who wants to
// waits for the end.
void AbandonStaging(absl::Duration patience);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_STAGING_FOLDER_H_
