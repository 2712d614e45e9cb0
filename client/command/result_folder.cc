#include "client/command/result_folder.h"

#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/atomic_file.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

namespace fs = std::filesystem;

constexpr char kLevel[] = ".level-";
constexpr char kCut[] = ".cut";

// "level-12." at the start of `rest` -> what follows; empty otherwise.
std::string AfterLevel(const std::string& rest) {
  if (!rest.starts_with(kLevel)) return "";
  const size_t begin = std::strlen(kLevel);
  size_t end = begin;
  while (end < rest.size() && absl::ascii_isdigit(rest[end])) ++end;
  return end == begin ? "" : rest.substr(end);
}

// The STEM whose result a file of STEM `stem` might be; empty for none.
std::string OwnerOf(const std::string& stem) {
  const fs::path path(stem);
  const std::string extension = path.extension().string();
  return extension == ".parts" || extension == kCut ||
                 AfterLevel(extension + ".") == "."
             ? path.stem().string()
             : "";
}

// A hidden folder inside `parent`, removed with all that is in it.
class StagingFolder {
 public:
  static absl::StatusOr<StagingFolder> Make(const std::string& parent) {
    std::string path = (fs::path(parent) / ".marrow-XXXXXX").string();
    if (mkdtemp(path.data()) == nullptr) {
      const absl::StatusCode code = errno == ENOSPC
                                        ? absl::StatusCode::kResourceExhausted
                                        : absl::StatusCode::kPermissionDenied;
      return absl::Status(
          code,
          absl::StrCat(parent, ": cannot write there: ", std::strerror(errno),
                       "; choose another folder with -o"));
    }
    return StagingFolder(path);
  }
  StagingFolder(StagingFolder&& other)
      : path_(std::exchange(other.path_, fs::path())) {}
  StagingFolder& operator=(StagingFolder&&) = delete;
  ~StagingFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }

  const fs::path& path() const { return path_; }

 private:
  explicit StagingFolder(fs::path path) : path_(std::move(path)) {}

  fs::path path_;
};

// Renames that can be taken back.
class Renames {
 public:
  ~Renames() {
    std::error_code ignored;
    for (; !done_.empty(); done_.pop_back()) {
      fs::rename(done_.back().second, done_.back().first, ignored);
    }
  }
  absl::Status Do(const fs::path& from, const fs::path& to,
                  const fs::path& shown) {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) {
      return absl::FailedPreconditionError(absl::StrCat(
          shown.string(), ": cannot be replaced: ", error.message(),
          "; move it away"));
    }
    done_.emplace_back(from, to);
    return absl::OkStatus();
  }
  void Keep() { done_.clear(); }

 private:
  std::vector<std::pair<fs::path, fs::path>> done_;
};

std::vector<fs::path> OldResults(const std::string& folder,
                                 const std::string& stem, ResultScope scope) {
  std::vector<fs::path> result;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const fs::file_status status = it->symlink_status(error);
    if (!error && (fs::is_regular_file(status) || fs::is_symlink(status)) &&
        IsResultName(stem, it->path().filename().string(), scope)) {
      result.push_back(it->path().filename());
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

absl::Status WriteAll(const fs::path& staging, const fs::path& folder,
                      const std::vector<ResultFile>& files) {
  for (const ResultFile& file : files) {
    const absl::Status status =
        WriteFileAtomically((staging / file.name).string(), file.bytes);
    if (!status.ok()) {
      return absl::Status(
          status.code(),
          absl::StrReplaceAll(status.message(),
                              {{staging.string(), folder.string()}}));
    }
  }
  return absl::OkStatus();
}

}  // namespace

std::string StemOf(const std::string& path) {
  const fs::path name = fs::path(path).filename();
  return name == "-" ? "stdin" : name.stem().string();
}

absl::Status CheckStems(const std::vector<std::string>& inputs) {
  std::map<std::string, std::string> owners;
  const auto clash = [](const std::string& a, const std::string& b) {
    return absl::InvalidArgumentError(
        absl::StrCat(a, " and ", b,
                     " would write the same files; segment them apart, into "
                     "two folders (-o)"));
  };
  for (const std::string& input : inputs) {
    const auto [it, is_new] = owners.emplace(StemOf(input), input);
    if (!is_new) return clash(it->second, input);
  }
  for (const auto& [stem, input] : owners) {
    const auto it = owners.find(OwnerOf(stem));
    if (it != owners.end()) return clash(it->second, input);
  }
  return absl::OkStatus();
}

absl::StatusOr<bool> PrepareFolder(const std::string& folder) {
  std::error_code error;
  const bool is_new = fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    return absl::PermissionDeniedError(
        absl::StrCat(folder, ": cannot be made or is no folder: ",
                     error ? error.message() : "a file has this name",
                     "; choose another one with -o"));
  }
  MARROW_RETURN_IF_ERROR(StagingFolder::Make(folder).status());
  return is_new;
}

bool IsResultName(const std::string& stem, const std::string& name,
                  ResultScope scope) {
  if (!name.starts_with(stem)) return false;
  const std::string rest = name.substr(stem.size());
  const bool is_cut = rest.starts_with(kCut);
  if (scope == ResultScope::kCut && !is_cut) return false;
  const std::string kind =
      is_cut ? rest.substr(std::strlen(kCut)) : AfterLevel(rest);
  if (kind == ".seg" || kind == ".ply" || kind == ".png") return true;
  const std::string whole = is_cut ? kind : rest;
  return whole == ".seg" || whole == ".json" || whole == ".parts.obj";
}

absl::Status PublishResults(const std::string& folder, const std::string& stem,
                            const std::vector<ResultFile>& files,
                            ResultScope scope) {
  MARROW_ASSIGN_OR_RETURN(const StagingFolder staging,
                          StagingFolder::Make(folder));
  MARROW_RETURN_IF_ERROR(WriteAll(staging.path(), folder, files));
  MARROW_ASSIGN_OR_RETURN(const StagingFolder old, StagingFolder::Make(folder));
  Renames renames;
  for (const fs::path& name : OldResults(folder, stem, scope)) {
    const fs::path path = folder / name;
    MARROW_RETURN_IF_ERROR(renames.Do(path, old.path() / name, path));
  }
  for (const ResultFile& file : files) {
    const fs::path path = fs::path(folder) / file.name;
    MARROW_RETURN_IF_ERROR(renames.Do(staging.path() / file.name, path, path));
  }
  renames.Keep();
  return absl::OkStatus();
}

}  // namespace marrow::client
