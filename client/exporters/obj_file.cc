#include "client/exporters/obj_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/exporters/label_split.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

// The fewest digits that read back as the same number.
template <typename T>
void AppendNumber(T value, std::string& out) {
  std::array<char, 32> digits;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

void AppendVertex(const std::array<double, 3>& position, bool floats,
                  std::string& out) {
  out += 'v';
  for (double x : position) {
    out += ' ';
    floats ? AppendNumber(ToFloat(x), out) : AppendNumber(x, out);
  }
  out += '\n';
}

struct ExportedFace {
  uint32_t label;
  size_t first_corner;  // in LabelSplit::corners
  size_t num_corners;
};

std::vector<ExportedFace> FacesByLabel(const PolygonMesh& mesh,
                                       std::span<const uint32_t> face_labels,
                                       const LabelSplit& split) {
  std::vector<ExportedFace> faces;
  size_t corner = 0;
  for (uint32_t f : split.faces) {
    faces.push_back({face_labels[f], corner, mesh.Face(f).size()});
    corner += mesh.Face(f).size();
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const ExportedFace& a, const ExportedFace& b) {
                     return a.label < b.label;
                   });
  return faces;
}

}  // namespace

absl::StatusOr<std::string> PartsObjFile(
    const PolygonMesh& mesh, std::span<const uint32_t> face_labels) {
  MARROW_ASSIGN_OR_RETURN(const LabelSplit split,
                          SplitByLabel(mesh, face_labels));
  const std::vector<ExportedFace> faces =
      FacesByLabel(mesh, face_labels, split);
  std::string obj = "# One object a segment, by Marrow\n";
  const bool floats = AreFloats(mesh.positions);
  size_t v = 0;
  for (size_t f = 0; f < faces.size();) {
    const uint32_t label = faces[f].label;
    absl::StrAppend(&obj, "o segment_", label, "\n");
    for (; v < split.vertices.size() && split.vertices[v].label == label; ++v) {
      AppendVertex(mesh.positions[split.vertices[v].vertex], floats, obj);
    }
    for (; f < faces.size() && faces[f].label == label; ++f) {
      obj += 'f';
      for (size_t i = 0; i < faces[f].num_corners; ++i) {
        const size_t corner = faces[f].first_corner + i;
        absl::StrAppend(&obj, " ", split.corners[corner] + uint64_t{1});
      }
      obj += '\n';
    }
  }
  return obj;
}

}  // namespace marrow
