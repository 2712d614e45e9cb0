#include "client/command/results.h"

#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/exporters/json_file.h"
#include "client/exporters/obj_file.h"
#include "client/exporters/ply_file.h"
#include "client/exporters/seg_file.h"
#include "client/picture/picture.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

absl::Status AddLevelFiles(const std::string& stem, const PolygonMesh& mesh,
                           const Level& level, bool png,
                           std::vector<ResultFile>& files) {
  const std::string name = absl::StrCat(stem, ".level-", level.level);
  files.push_back({name + ".seg", SegFile(level.face_labels)});
  MARROW_ASSIGN_OR_RETURN(std::string ply, PlyFile(mesh, level.face_labels));
  files.push_back({name + ".ply", std::move(ply)});
  if (!png) return absl::OkStatus();
  MARROW_ASSIGN_OR_RETURN(std::string picture,
                          DrawPng(mesh, level.face_labels, level.skeleton));
  files.push_back({name + ".png", std::move(picture)});
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Segmentation> InFileOrder(Segmentation answer,
                                         const OrderMap& order) {
  for (Level& level : answer.levels) {
    MARROW_ASSIGN_OR_RETURN(level.face_labels,
                            order.FaceLabelsInFileOrder(level.face_labels));
    MARROW_ASSIGN_OR_RETURN(level.vertex_labels,
                            order.VertexLabelsInFileOrder(level.vertex_labels));
  }
  for (SegmentNode& node : answer.nodes) {
    MARROW_ASSIGN_OR_RETURN(node.medial_structure,
                            order.FileVertices(node.medial_structure));
  }
  return answer;
}

absl::StatusOr<std::vector<ResultFile>> MakeResultFiles(
    const std::string& name, const PolygonMesh& mesh,
    const Segmentation& segmentation, const ResultOptions& options) {
  const std::string stem = StemOf(name);
  const Level& cut = segmentation.AutomaticCut();
  std::vector<ResultFile> files;
  files.push_back({stem + ".seg", SegFile(cut.face_labels)});
  files.push_back({stem + ".json", JsonFile(name, mesh, segmentation)});
  for (const Level& level : segmentation.levels) {
    MARROW_RETURN_IF_ERROR(
        AddLevelFiles(stem, mesh, level, options.png, files));
  }
  if (options.parts) {
    MARROW_ASSIGN_OR_RETURN(std::string obj,
                            PartsObjFile(mesh, cut.face_labels));
    files.push_back({stem + ".parts.obj", std::move(obj)});
  }
  return files;
}

std::string CountSegments(const Segmentation& segmentation) {
  std::string text;
  for (const Level& level : segmentation.levels) {
    const size_t count =
        std::set<uint32_t>(level.face_labels.begin(), level.face_labels.end())
            .size();
    absl::StrAppend(&text, text.empty() ? "" : ", ", count,
                    text.empty() ? (count == 1 ? " segment" : " segments") : "",
                    " at level ", level.level);
  }
  return text;
}

}  // namespace marrow::client
