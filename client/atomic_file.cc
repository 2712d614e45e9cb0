#include "client/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "absl/strings/str_cat.h"

namespace marrow {
namespace {

absl::Status WriteError(const std::string& path, int error) {
  const std::string what =
      absl::StrCat(path, ": cannot write: ", std::strerror(error));
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return absl::NotFoundError(
          absl::StrCat(what, "; create its folder first"));
    case EACCES:
    case EPERM:
    case EROFS:
      return absl::PermissionDeniedError(
          absl::StrCat(what, "; choose a place you may write to"));
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return absl::ResourceExhaustedError(
          absl::StrCat(what, "; free some space or choose another disk"));
    default:
      return absl::UnknownError(what);
  }
}

absl::Status IsFolderError(const std::string& path) {
  return absl::FailedPreconditionError(
      absl::StrCat(path, ": is a folder; name a file inside it"));
}

// An open file, closed when it goes out of scope.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { Close(); }

  int get() const { return fd_; }
  bool Close() {
    const int fd = fd_;
    fd_ = -1;
    return fd < 0 || close(fd) == 0;
  }

 private:
  int fd_;
};

bool WriteAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<size_t>(written));
  }
  return true;
}

absl::Status WriteInPlace(const std::string& path, std::string_view bytes) {
  Descriptor file(open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0 || !WriteAll(file.get(), bytes) || !file.Close()) {
    return WriteError(path, errno);
  }
  return absl::OkStatus();
}

// Where a rename must land so that symbolic links on the way stay links. A
// dangling link leads to the file it names.
std::string FollowLinks(const std::string& path) {
  constexpr int kMaxLinks = 40;
  std::filesystem::path target(path);
  std::error_code error;
  for (int i = 0; i < kMaxLinks; ++i) {
    const std::filesystem::path next =
        std::filesystem::read_symlink(target, error);
    if (error) break;
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target.string();
}

std::string TemporaryNameBeside(const std::string& target) {
  static std::atomic<uint64_t> counter = 0;
  const std::string name =
      absl::StrCat(".marrow-", getpid(), "-", counter++, ".tmp");
  return (std::filesystem::path(target).parent_path() / name).string();
}

// Returns 0 or an errno.
int WriteTemporary(const std::string& temporary, std::string_view bytes,
                   const struct stat* old) {
  // A name left by a killed process that had this id is ours to reuse.
  unlink(temporary.c_str());
  Descriptor file(
      open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.get() < 0) return errno;
  const bool ok =
      (old == nullptr || fchmod(file.get(), old->st_mode & 07777) == 0) &&
      WriteAll(file.get(), bytes) && fsync(file.get()) == 0 && file.Close();
  return ok ? 0 : errno;
}

}  // namespace

absl::Status CheckWritable(const std::string& path) {
  struct stat old;
  const bool exists = stat(path.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) return IsFolderError(path);
  if (exists && !S_ISREG(old.st_mode)) return absl::OkStatus();
  const auto folder = std::filesystem::path(FollowLinks(path)).parent_path();
  return access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) == 0
             ? absl::OkStatus()
             : WriteError(path, errno);
}

absl::Status WriteFileAtomically(const std::string& path,
                                 std::string_view bytes) {
  struct stat old;
  const bool exists = stat(path.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) return IsFolderError(path);
  if (exists && !S_ISREG(old.st_mode)) return WriteInPlace(path, bytes);

  const std::string target = FollowLinks(path);
  const std::string temporary = TemporaryNameBeside(target);
  int error = WriteTemporary(temporary, bytes, exists ? &old : nullptr);
  if (error == 0 && rename(temporary.c_str(), target.c_str()) != 0) {
    error = errno;
  }
  if (error == 0) return absl::OkStatus();
  if (error != EEXIST) unlink(temporary.c_str());
  return WriteError(path, error);
}

}  // namespace marrow
