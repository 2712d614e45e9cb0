#include "client/command/earlier_results.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "client/command/result_folder.h"
#include "client/exporters/json_file.h"

namespace marrow::client {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// How parts and pictures of Marrow's begin: a PNG of 1600 x 800 pixels, RGB,
// with no chunk before the pixels but sRGB.
constexpr std::string_view kPartsBegin = "# One object a segment, by Marrow\n";
constexpr std::string_view kPictureBegin(
    "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x06\x40\0\0\x03\x20\x08\x02\0\0\0"
    "\xf4\xa2\x39\x0d\0\0\0\x01sRGB",
    41);

// The members that tell what was written; null for what is no JSON of ours.
json ReadRecord(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return nullptr;
  std::ifstream file(path);
  const auto keep = [](int depth, json::parse_event_t event, json& parsed) {
    if (depth != 1 || event != json::parse_event_t::key) return true;
    return parsed == "schema" || parsed == "files" || parsed == "levels" ||
           parsed == "cut";
  };
  json record = json::parse(file, keep, false);
  if (!record.is_object()) return nullptr;
  const json schema = record.value("schema", json());
  return schema == kJsonSchema || schema == kCutJsonSchema ? record : nullptr;
}

bool BeginsWith(const fs::path& path, std::string_view begin) {
  std::string bytes(begin.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file.good() && bytes == begin;
}

// Names that were written together, as a record without a list of them implies.
class ImpliedNames {
 public:
  ImpliedNames(fs::path folder, std::set<std::string>& names)
      : folder_(std::move(folder)), names_(names) {}

  void Add(const std::string& name) { names_.insert(name); }
  void AddLevel(const std::string& stem) {
    Add(stem + ".seg");
    Add(stem + ".ply");
    AddIf(stem + ".png", kPictureBegin);
  }
  void AddParts(const std::string& stem) {
    AddIf(stem + ".parts.obj", kPartsBegin);
  }

 private:
  // Whether it was asked for is not told.
  void AddIf(const std::string& name, std::string_view begin) {
    if (BeginsWith(folder_ / name, begin)) Add(name);
  }

  const fs::path folder_;
  std::set<std::string>& names_;
};

void AddImplied(const json& record, const std::string& stem,
                ImpliedNames& names) {
  const std::string cut = stem + ".cut";
  if (record.contains("cut") && record["cut"].is_object()) names.AddLevel(cut);
  if (record["schema"] == kCutJsonSchema) {
    names.Add(cut + ".json");
    return names.AddParts(cut);
  }
  names.Add(stem + ".seg");
  names.Add(stem + ".json");
  names.AddParts(stem);
  if (!record.contains("levels") || !record["levels"].is_array()) return;
  for (const json& level : record["levels"]) {
    if (!level.is_object() || !level.contains("level")) continue;
    names.AddLevel(absl::StrCat(stem, ".level-", level["level"].dump()));
  }
}

// As JSON has it: bytes that are not UTF-8 are replaced.
std::string AsText(const std::string& bytes) {
  return json::parse(
      json(bytes).dump(-1, ' ', false, json::error_handler_t::replace));
}

void AddRecorded(const fs::path& folder, const std::string& stem,
                 const std::string& record_name, std::set<std::string>& names) {
  const json record = ReadRecord(folder / record_name);
  if (record.is_null()) return;
  if (!record.contains("files")) {
    ImpliedNames implied(folder, names);
    return AddImplied(record, stem, implied);
  }
  const std::string text = AsText(stem);
  for (const json& name : record["files"]) {
    if (!name.is_string()) continue;
    const std::string listed = name.get<std::string>();
    if (listed.starts_with(text)) {
      names.insert(stem + listed.substr(text.size()));
    }
  }
}

}  // namespace

std::vector<std::string> EarlierResults(const std::string& folder,
                                        const std::string& stem) {
  std::set<std::string> names;
  AddRecorded(folder, stem, stem + ".json", names);
  AddRecorded(folder, stem, stem + ".cut.json", names);
  // A file that says of itself what it is may say anything.
  std::erase_if(names, [&](const std::string& name) {
    return !IsResultName(stem, name);
  });
  return {names.begin(), names.end()};
}

}  // namespace marrow::client
