#include "client/exporters/ply_file.h"

#include <bit>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "client/exporters/label_split.h"
#include "client/exporters/palette.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

void AppendBytes(uint64_t value, int bytes, std::string& out) {
  char buffer[8];
  for (int i = 0; i < bytes; ++i) {
    buffer[i] = static_cast<char>(value >> (8 * i));
  }
  out.append(buffer, bytes);
}

void AppendUint32(uint32_t value, std::string& out) {
  AppendBytes(value, 4, out);
}

void AppendColor(uint32_t label, std::string& out) {
  const Rgb color = SegmentColor(label);
  AppendBytes(color.red | color.green << 8 | color.blue << 16, 3, out);
}

std::string Header(const LabelSplit& split, bool floats, bool wide_count) {
  const std::string type = floats ? "float" : "double";
  const std::string colors =
      "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  return absl::StrCat(
      "ply\nformat binary_little_endian 1.0\ncomment Coloured by Marrow\n",
      "element vertex ", split.vertices.size(), "\n", "property ", type,
      " x\nproperty ", type, " y\nproperty ", type, " z\n", colors,
      "element face ", split.faces.size(), "\n", "property list ",
      wide_count ? "uint" : "uchar", " int vertex_indices\n", colors,
      "end_header\n");
}

}  // namespace

absl::StatusOr<std::string> PlyFile(const PolygonMesh& mesh,
                                    std::span<const uint32_t> face_labels) {
  MARROW_ASSIGN_OR_RETURN(const LabelSplit split,
                          SplitByLabel(mesh, face_labels));
  bool wide_count = false;
  for (uint32_t f : split.faces) wide_count |= mesh.Face(f).size() > 255;
  const bool floats = AreFloats(mesh.positions);
  std::string ply = Header(split, floats, wide_count);
  for (const auto& [label, vertex] : split.vertices) {
    for (double x : mesh.positions[vertex]) {
      if (floats) {
        AppendUint32(std::bit_cast<uint32_t>(ToFloat(x)), ply);
      } else {
        AppendBytes(std::bit_cast<uint64_t>(x), 8, ply);
      }
    }
    AppendColor(label, ply);
  }
  size_t corner = 0;
  for (uint32_t f : split.faces) {
    const size_t count = mesh.Face(f).size();
    if (wide_count) {
      AppendUint32(static_cast<uint32_t>(count), ply);
    } else {
      ply.push_back(static_cast<char>(count));
    }
    for (size_t i = 0; i < count; ++i) {
      AppendUint32(split.corners[corner++], ply);
    }
    AppendColor(face_labels[f], ply);
  }
  return ply;
}

}  // namespace marrow
