#include "client/command/staging_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"

namespace marrow::client {
namespace {

namespace fs = std::filesystem;

struct Staging {
  absl::Mutex mutex;
  std::set<fs::path> folders ABSL_GUARDED_BY(mutex);
  int moves ABSL_GUARDED_BY(mutex) = 0;
  bool abandoned ABSL_GUARDED_BY(mutex) = false;

  bool IsOpen() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex) {
    return !abandoned;
  }
  bool NothingMoves() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex) {
    return moves == 0;
  }
};

// Never destroyed: threads may work until the process is gone.
Staging& TheStaging() {
  static Staging& staging = *new Staging;
  return staging;
}

// A file that is being written may come after its folder was looked at.
void RemoveAll(const fs::path& folder) {
  constexpr int kTries = 10;
  std::error_code error;
  for (int i = 0; i < kTries && fs::exists(folder, error); ++i) {
    fs::remove_all(folder, error);
  }
}

}  // namespace

absl::StatusOr<StagingFolder> StagingFolder::Make(const std::string& parent) {
  Staging& staging = TheStaging();
  absl::MutexLock lock(&staging.mutex,
                       absl::Condition(&staging, &Staging::IsOpen));
  std::string path = (fs::path(parent) / ".marrow-XXXXXX").string();
  if (mkdtemp(path.data()) == nullptr) {
    const absl::StatusCode code = errno == ENOSPC
                                      ? absl::StatusCode::kResourceExhausted
                                      : absl::StatusCode::kPermissionDenied;
    return absl::Status(code, absl::StrCat(parent, ": cannot write there: ",
                                           std::strerror(errno),
                                           "; choose another folder with -o"));
  }
  staging.folders.insert(path);
  return StagingFolder(path);
}

StagingFolder::StagingFolder(fs::path path) : path_(std::move(path)) {}

StagingFolder::StagingFolder(StagingFolder&& other) noexcept
    : path_(std::exchange(other.path_, fs::path())) {}

StagingFolder::~StagingFolder() {
  if (path_.empty()) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  Staging& staging = TheStaging();
  absl::MutexLock lock(&staging.mutex);
  staging.folders.erase(path_);
}

FilesMove::FilesMove() {
  Staging& staging = TheStaging();
  absl::MutexLock lock(&staging.mutex,
                       absl::Condition(&staging, &Staging::IsOpen));
  ++staging.moves;
}

FilesMove::~FilesMove() {
  Staging& staging = TheStaging();
  absl::MutexLock lock(&staging.mutex);
  --staging.moves;
}

void AbandonStaging(absl::Duration patience) {
  Staging& staging = TheStaging();
  absl::MutexLock lock(&staging.mutex);
  staging.abandoned = true;
  // What an old result was moved into must not go before it is moved back.
  if (!staging.mutex.AwaitWithTimeout(
          absl::Condition(&staging, &Staging::NothingMoves), patience)) {
    return;
  }
  for (const fs::path& folder : staging.folders) RemoveAll(folder);
}

}  // namespace marrow::client
