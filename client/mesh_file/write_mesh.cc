#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "client/atomic_file.h"
#include "client/mesh_file/mesh_file.h"
#include "client/mesh_file/triangulate.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

static_assert(std::endian::native == std::endian::little);

template <typename T>
void AppendNumber(T value, std::string* out) {
  std::array<char, 32> text;
  const std::to_chars_result result =
      std::to_chars(text.data(), text.data() + text.size(), value);
  out->append(text.data(), result.ptr);
}

template <typename T>
void AppendBytes(T value, std::string* out) {
  out->append(reinterpret_cast<const char*>(&value), sizeof(value));
}

void AppendPoint(const std::array<double, 3>& point, bool floats,
                 std::string* out) {
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) out->push_back(' ');
    if (floats) {
      AppendNumber(ToFloat(point[axis]), out);
    } else {
      AppendNumber(point[axis], out);
    }
  }
  out->push_back('\n');
}

void AppendFloats(const std::array<double, 3>& point, std::string* out) {
  for (const double x : point) AppendBytes(ToFloat(x), out);
}

void AppendCorners(std::span<const uint32_t> corners, uint64_t first_index,
                   std::string* out) {
  for (const uint32_t corner : corners) {
    out->push_back(' ');
    AppendNumber(first_index + corner, out);
  }
  out->push_back('\n');
}

std::string OffBytes(const PolygonMesh& mesh) {
  std::string out =
      absl::StrCat("OFF\n", mesh.NumVertices(), " ", mesh.NumFaces(), " 0\n");
  const bool floats = AreFloats(mesh.positions);
  for (const auto& point : mesh.positions) AppendPoint(point, floats, &out);
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    AppendNumber(mesh.Face(f).size(), &out);
    AppendCorners(mesh.Face(f), 0, &out);
  }
  return out;
}

std::string ObjBytes(const PolygonMesh& mesh) {
  std::string out;
  const bool floats = AreFloats(mesh.positions);
  for (const auto& point : mesh.positions) {
    out += "v ";
    AppendPoint(point, floats, &out);
  }
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    out += "f";
    AppendCorners(mesh.Face(f), 1, &out);
  }
  return out;
}

std::string PlyBytes(const PolygonMesh& mesh) {
  size_t most_corners = 0;
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    most_corners = std::max(most_corners, mesh.Face(f).size());
  }
  const bool small = most_corners <= 255;
  const bool floats = AreFloats(mesh.positions);
  const std::string type = floats ? "float" : "double";
  std::string out = absl::StrCat(
      "ply\nformat binary_little_endian 1.0\nelement vertex ",
      mesh.NumVertices(), "\nproperty ", type, " x\nproperty ", type,
      " y\nproperty ", type, " z\nelement face ", mesh.NumFaces(),
      "\nproperty list ", small ? "uchar" : "uint",
      " int vertex_indices\nend_header\n");
  for (const auto& point : mesh.positions) {
    if (floats) {
      AppendFloats(point, &out);
    } else {
      AppendBytes(point, &out);
    }
  }
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    const uint32_t corners = static_cast<uint32_t>(mesh.Face(f).size());
    if (small) {
      AppendBytes(static_cast<uint8_t>(corners), &out);
    } else {
      AppendBytes(corners, &out);
    }
    for (const uint32_t corner : mesh.Face(f)) AppendBytes(corner, &out);
  }
  return out;
}

// Normals are left zero: readers are to compute them from the corners.
std::string StlBytes(const PolygonMesh& mesh) {
  std::vector<std::array<uint32_t, 3>> triangles;
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    Triangulate(mesh, f, &triangles);
  }
  std::string out(80, ' ');
  AppendBytes(static_cast<uint32_t>(triangles.size()), &out);
  for (const std::array<uint32_t, 3>& triangle : triangles) {
    AppendBytes(std::array<float, 3>{}, &out);
    for (const uint32_t v : triangle) AppendFloats(mesh.positions[v], &out);
    AppendBytes(uint16_t{0}, &out);
  }
  return out;
}

}  // namespace

absl::Status WriteMesh(const PolygonMesh& mesh, const std::string& path) {
  switch (DetectMeshFormat(path, {})) {
    case MeshFormat::kOff:
      return WriteFileAtomically(path, OffBytes(mesh));
    case MeshFormat::kObj:
      return WriteFileAtomically(path, ObjBytes(mesh));
    case MeshFormat::kPly:
      return WriteFileAtomically(path, PlyBytes(mesh));
    case MeshFormat::kStl:
      return WriteFileAtomically(path, StlBytes(mesh));
    default:
      return absl::InvalidArgumentError(absl::StrCat(
          path, ": cannot write this format; use .off, .obj, .ply or .stl"));
  }
}

}  // namespace marrow
