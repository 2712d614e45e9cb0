// The files that one input leaves behind: all of them, or none.
#ifndef MARROW_CLIENT_COMMAND_RESULT_FOLDER_H_
#define MARROW_CLIENT_COMMAND_RESULT_FOLDER_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace marrow::client {

// The name of an input without folder and last extension; "stdin" for "-",
// which is standard input.
std::string StemOf(const std::string& path);

// INVALID_ARGUMENT where two inputs would write one file: they have one STEM,
// or one's STEM is a result's of the other, such as a and a.level-1.
absl::Status CheckStems(const std::vector<std::string>& inputs);

// Makes the folder, and those above it, where they are missing, and checks that
// files can be made in it. The value are those that it made, the deepest first;
// none after an error. Errors name the folder and say what to do.
absl::StatusOr<std::vector<std::string>> PrepareFolder(
    const std::string& folder);

// Those of them that are empty.
void RemoveFolders(const std::vector<std::string>& folders);

struct ResultFile {
  std::string name;  // without folder
  std::string bytes;
};

enum class ResultScope {
  kAll,
  kCut,  // STEM.cut.*: a new cut leaves the others alone
};

struct PublishOptions {
  ResultScope scope = ResultScope::kAll;
  std::vector<std::string> inputs;  // files that stay, whatever they are called
};

// Puts `files` into `folder`, over what has their names. What EarlierResults()
// knows of `stem` and this run does not write again (a deeper level, a picture)
// goes. Until all are written the old ones stand; after an error they still do.
// Other files, and folders, are left alone.
//
// Errors: those of WriteFileAtomically; FAILED_PRECONDITION where an input or a
// folder has a result's name.
absl::Status PublishResults(const std::string& folder, const std::string& stem,
                            const std::vector<ResultFile>& files,
                            const PublishOptions& options = {});

// STEM.seg, STEM.json, STEM.parts.obj, STEM.level-N.{seg,ply,png},
// STEM.cut.{seg,ply,png,json,parts.obj}.
bool IsResultName(const std::string& stem, const std::string& name,
                  ResultScope scope = ResultScope::kAll);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_RESULT_FOLDER_H_
