#include "client/command/result_folder.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/atomic_file.h"
#include "client/command/earlier_results.h"
#include "client/command/staging_folder.h"
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

// Whether a file that can be replaced has this name; folders cannot.
bool IsFile(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::symlink_status(path, ignored);
  return fs::is_regular_file(status) || fs::is_symlink(status);
}

bool IsAnyOf(const fs::path& path, const std::vector<std::string>& inputs) {
  return std::any_of(inputs.begin(), inputs.end(),
                     [&](const std::string& input) {
                       std::error_code ignored;
                       return fs::equivalent(path, input, ignored);
                     });
}

// What goes when `files` come: results of earlier runs, and whatever has a name
// of theirs. Inputs stay.
absl::StatusOr<std::vector<std::string>> ToReplace(
    const std::string& folder, const std::string& stem,
    const std::vector<ResultFile>& files, const PublishOptions& options) {
  std::set<std::string> names;
  for (const std::string& name : EarlierResults(folder, stem)) {
    if (IsResultName(stem, name, options.scope) &&
        !IsAnyOf(fs::path(folder) / name, options.inputs)) {
      names.insert(name);
    }
  }
  for (const ResultFile& file : files) {
    const fs::path path = fs::path(folder) / file.name;
    if (IsAnyOf(path, options.inputs)) {
      return absl::FailedPreconditionError(
          absl::StrCat(path.string(),
                       ": is an input, and a result would take its place; "
                       "choose another folder with -o"));
    }
    names.insert(file.name);
  }
  std::erase_if(names, [&](const std::string& name) {
    return !IsFile(fs::path(folder) / name);
  });
  return std::vector<std::string>(names.begin(), names.end());
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

absl::StatusOr<std::vector<std::string>> PrepareFolder(
    const std::string& folder) {
  std::vector<std::string> made;
  std::error_code error;
  fs::path path(folder);
  if (!path.has_filename()) path = path.parent_path();  // it ends in a slash
  for (; path.has_relative_path(); path = path.parent_path()) {
    // A link that leads nowhere is somebody's.
    if (fs::symlink_status(path, error).type() == fs::file_type::not_found)
      made.push_back(path.string());
  }
  error.clear();
  fs::create_directories(folder, error);
  const bool is_folder = !error && fs::is_directory(folder, error);
  absl::Status status =
      is_folder ? StagingFolder::Make(folder).status()
                : absl::PermissionDeniedError(absl::StrCat(
                      folder, ": cannot be made or is no folder: ",
                      error ? error.message() : "a file has this name",
                      "; choose another one with -o"));
  if (status.ok()) return made;
  RemoveFolders(made);
  return status;
}

void RemoveFolders(const std::vector<std::string>& folders) {
  for (const std::string& folder : folders) rmdir(folder.c_str());
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
                            const PublishOptions& options) {
  MARROW_ASSIGN_OR_RETURN(const std::vector<std::string> replaced,
                          ToReplace(folder, stem, files, options));
  MARROW_ASSIGN_OR_RETURN(const StagingFolder staging,
                          StagingFolder::Make(folder));
  MARROW_RETURN_IF_ERROR(WriteAll(staging.path(), folder, files));
  MARROW_ASSIGN_OR_RETURN(const StagingFolder old, StagingFolder::Make(folder));
  const FilesMove files_move;
  Renames renames;
  for (const std::string& name : replaced) {
    const fs::path path = fs::path(folder) / name;
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
