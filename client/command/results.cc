#include "client/command/results.h"

#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/exporters/json_file.h"
#include "client/exporters/obj_file.h"
#include "client/exporters/ply_file.h"
#include "client/exporters/seg_file.h"
#include "client/picture/picture.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

// `name` is the files' without its last extension.
absl::Status AddLevelFiles(const std::string& name, const PolygonMesh& mesh,
                           const Level& level, const ResultOptions& options,
                           std::vector<ResultFile>& files) {
  files.push_back({name + ".seg", SegFile(level.face_labels)});
  MARROW_ASSIGN_OR_RETURN(std::string ply, PlyFile(mesh, level.face_labels));
  files.push_back({name + ".ply", std::move(ply)});
  if (!options.png) return absl::OkStatus();
  if (absl::Now() >= options.deadline) {
    return absl::DeadlineExceededError("pictures are left to draw");
  }
  MARROW_ASSIGN_OR_RETURN(std::string picture,
                          DrawPng(mesh, level.face_labels, level.skeleton));
  files.push_back({name + ".png", std::move(picture)});
  return absl::OkStatus();
}

absl::Status ReorderLevel(const OrderMap& order, Level& level) {
  MARROW_ASSIGN_OR_RETURN(level.face_labels,
                          order.FaceLabelsInFileOrder(level.face_labels));
  MARROW_ASSIGN_OR_RETURN(level.vertex_labels,
                          order.VertexLabelsInFileOrder(level.vertex_labels));
  return absl::OkStatus();
}

absl::Status ReorderNodes(const OrderMap& order,
                          std::vector<SegmentNode>& nodes) {
  for (SegmentNode& node : nodes) {
    MARROW_ASSIGN_OR_RETURN(node.medial_structure,
                            order.FileVertices(node.medial_structure));
  }
  return absl::OkStatus();
}

CutNote NoteOf(const CutChoice& cut) {
  return {cut.text, cut.closed, cut.open};
}

std::vector<std::string> NamesOf(const std::vector<ResultFile>& files,
                                 const std::string& last) {
  std::vector<std::string> names;
  names.reserve(files.size() + 1);
  for (const ResultFile& file : files) names.push_back(file.name);
  names.push_back(last);
  return names;
}

size_t NumSegments(const Level& level) {
  return std::set<uint32_t>(level.face_labels.begin(), level.face_labels.end())
      .size();
}

}  // namespace

absl::StatusOr<Segmentation> InFileOrder(Segmentation answer,
                                         const OrderMap& order) {
  for (Level& level : answer.levels) {
    MARROW_RETURN_IF_ERROR(ReorderLevel(order, level));
  }
  MARROW_RETURN_IF_ERROR(ReorderNodes(order, answer.nodes));
  if (answer.cut.has_value()) {
    MARROW_RETURN_IF_ERROR(PutInFileOrder(order, *answer.cut));
  }
  return answer;
}

absl::Status PutInFileOrder(const OrderMap& order, Cut& cut) {
  MARROW_RETURN_IF_ERROR(ReorderLevel(order, cut.level));
  return ReorderNodes(order, cut.segments);
}

absl::StatusOr<std::vector<ResultFile>> MakeResultFiles(
    const std::string& name, const PolygonMesh& mesh,
    const Segmentation& segmentation, const ResultOptions& options,
    const CutChoice& cut) {
  const std::string stem = StemOf(name);
  const std::vector<uint32_t>& labels = segmentation.CutLevel().face_labels;
  std::vector<ResultFile> files;
  files.push_back({stem + ".seg", SegFile(labels)});
  if (segmentation.cut.has_value()) {
    MARROW_RETURN_IF_ERROR(AddLevelFiles(
        stem + ".cut", mesh, segmentation.cut->level, options, files));
  }
  for (const Level& level : segmentation.levels) {
    MARROW_RETURN_IF_ERROR(
        AddLevelFiles(absl::StrCat(stem, ".level-", level.level), mesh, level,
                      options, files));
  }
  if (options.parts) {
    MARROW_ASSIGN_OR_RETURN(std::string obj, PartsObjFile(mesh, labels));
    files.push_back({stem + ".parts.obj", std::move(obj)});
  }
  const std::string record = stem + ".json";
  files.push_back({record, JsonFile(name, mesh, segmentation, NoteOf(cut),
                                    NamesOf(files, record))});
  return files;
}

absl::StatusOr<std::vector<ResultFile>> MakeCutFiles(
    const std::string& name, const PolygonMesh& mesh, const CutAnswer& answer,
    const ResultOptions& options, const CutChoice& cut) {
  const std::string stem = StemOf(name) + ".cut";
  std::vector<ResultFile> files;
  MARROW_RETURN_IF_ERROR(
      AddLevelFiles(stem, mesh, answer.cut.level, options, files));
  if (options.parts) {
    MARROW_ASSIGN_OR_RETURN(std::string obj,
                            PartsObjFile(mesh, answer.cut.level.face_labels));
    files.push_back({stem + ".parts.obj", std::move(obj)});
  }
  const std::string record = stem + ".json";
  files.push_back({record, CutJsonFile(name, mesh, answer, NoteOf(cut),
                                       NamesOf(files, record))});
  return files;
}

std::string CountSegments(const Segmentation& segmentation) {
  std::string text;
  for (const Level& level : segmentation.levels) {
    const size_t count = NumSegments(level);
    absl::StrAppend(&text, text.empty() ? "" : ", ", count,
                    text.empty() ? (count == 1 ? " segment" : " segments") : "",
                    " at level ", level.level);
  }
  if (segmentation.cut.has_value()) {
    absl::StrAppend(&text, ", ", NumSegments(segmentation.cut->level),
                    " in the cut");
  }
  return text;
}

}  // namespace marrow::client
