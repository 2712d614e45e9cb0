// Not through tinyobjloader: it reads "nan" and any text it does not know as 0,
// drops faces with fewer than three corners, and only warns of a bad index.
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "client/mesh_file/readers.h"
#include "client/mesh_file/text_precision.h"
#include "client/mesh_file/text_scanner.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

constexpr uint32_t kAbsent = 0xFFFFFFFFu;

class ObjReader {
 public:
  ObjReader(const std::string& path, std::string_view text)
      : scanner_(path, text, {.comments = true, .continuations = true}) {}

  absl::StatusOr<PolygonMesh> Read();

 private:
  absl::Status ReadLine();
  absl::Status ReadFace();
  absl::Status ReadCorner(std::string_view token);
  // Index as the file counts, from 1 or backwards from -1, to one from 0. It
  // may be at or over `count`.
  absl::Status ReadIndex(std::string_view token, size_t count, uint32_t* index);
  absl::Status CheckForwardReferences();
  // A coordinate is a double; the others are floats.
  bool Parse(std::string_view token, float* number) {
    return ParseFloat(token, number);
  }
  bool Parse(std::string_view token, double* number) {
    return precision_.Parse(token, number);
  }
  // A row of N numbers, of which those beyond `needed` may be left out: then
  // they are 0.
  template <typename T, size_t N>
  absl::Status ReadNumbers(std::vector<std::array<T, N>>* rows,
                           size_t needed = N);
  template <size_t N>
  static std::vector<std::array<float, N>> Expand(
      const std::vector<std::array<float, N>>& rows,
      const std::vector<uint32_t>& index);

  // A corner whose vertex had not been read yet when the face was.
  struct ForwardReference {
    uint32_t vertex;
    size_t line;
  };

  TextScanner scanner_;
  TextPrecision precision_;
  PolygonMesh mesh_;
  std::vector<std::array<float, 2>> uvs_;
  std::vector<std::array<float, 3>> normals_;
  std::vector<uint32_t> corner_uv_;  // parallel to face_vertices
  std::vector<uint32_t> corner_normal_;
  std::vector<ForwardReference> forward_references_;
};

template <typename T, size_t N>
absl::Status ObjReader::ReadNumbers(std::vector<std::array<T, N>>* rows,
                                    size_t needed) {
  std::array<T, N> row = {};
  for (size_t i = 0; i < N; ++i) {
    const std::string_view token = scanner_.NextToken();
    if (token.empty() && i >= needed) break;
    if (token.empty()) {
      return scanner_.Error(
          absl::StrCat("needs ", needed, needed == 1 ? " number" : " numbers"));
    }
    if (!Parse(token, &row[i])) {
      return scanner_.Error(absl::StrCat(Quoted(token), " is not a number"));
    }
  }
  rows->push_back(row);
  return absl::OkStatus();
}

absl::Status ObjReader::ReadIndex(std::string_view token, size_t count,
                                  uint32_t* index) {
  int64_t number = 0;
  if (!ParseInt64(token, &number)) {
    return scanner_.Error(absl::StrCat(Quoted(token), " is not an index"));
  }
  const int64_t base = static_cast<int64_t>(count);
  const int64_t from_zero = number < 0 ? base + number : number - 1;
  if (number == 0 || from_zero < 0 || from_zero >= kAbsent) {
    return scanner_.Error(absl::StrCat(
        "index ", number, " is out of range (", count,
        " were read so far, counted from 1, or backwards from -1)"));
  }
  *index = static_cast<uint32_t>(from_zero);
  return absl::OkStatus();
}

absl::Status ObjReader::ReadCorner(std::string_view token) {
  std::array<std::string_view, 3> parts;  // vertex, texture, normal
  for (size_t i = 0; i < parts.size() && !token.empty(); ++i) {
    const size_t slash = std::min(token.find('/'), token.size());
    parts[i] = token.substr(0, slash);
    token.remove_prefix(std::min(slash + 1, token.size()));
  }
  uint32_t vertex = 0;
  uint32_t uv = kAbsent;
  uint32_t normal = kAbsent;
  MARROW_RETURN_IF_ERROR(ReadIndex(parts[0], mesh_.NumVertices(), &vertex));
  if (!parts[1].empty()) {
    MARROW_RETURN_IF_ERROR(ReadIndex(parts[1], uvs_.size(), &uv));
  }
  if (!parts[2].empty()) {
    MARROW_RETURN_IF_ERROR(ReadIndex(parts[2], normals_.size(), &normal));
  }
  if (vertex >= mesh_.NumVertices()) {
    forward_references_.push_back({vertex, scanner_.line()});
  }
  mesh_.face_vertices.push_back(vertex);
  corner_uv_.push_back(uv);
  corner_normal_.push_back(normal);
  return absl::OkStatus();
}

absl::Status ObjReader::ReadFace() {
  for (std::string_view token = scanner_.NextToken(); !token.empty();
       token = scanner_.NextToken()) {
    MARROW_RETURN_IF_ERROR(ReadCorner(token));
  }
  mesh_.face_offsets.push_back(
      static_cast<uint32_t>(mesh_.face_vertices.size()));
  return absl::OkStatus();
}

// Everything else (groups, materials, lines, curves) has no faces.
absl::Status ObjReader::ReadLine() {
  const std::string_view keyword = scanner_.NextToken();
  if (keyword == "v") return ReadNumbers(&mesh_.positions);
  if (keyword == "vt") return ReadNumbers(&uvs_, 1);
  if (keyword == "vn") return ReadNumbers(&normals_);
  if (keyword == "f" || keyword == "fo") return ReadFace();
  return absl::OkStatus();
}

absl::Status ObjReader::CheckForwardReferences() {
  for (const ForwardReference& reference : forward_references_) {
    if (reference.vertex < mesh_.NumVertices()) continue;
    return absl::InvalidArgumentError(absl::StrCat(
        scanner_.path(), ": line ", reference.line, ": vertex index ",
        reference.vertex + 1ull, " is out of range (the file has ",
        mesh_.NumVertices(), " vertices, counted from 1)"));
  }
  return absl::OkStatus();
}

// Empty unless every corner has a row: a seam along missing values is none.
template <size_t N>
std::vector<std::array<float, N>> ObjReader::Expand(
    const std::vector<std::array<float, N>>& rows,
    const std::vector<uint32_t>& index) {
  std::vector<std::array<float, N>> expanded;
  if (rows.empty()) return expanded;
  expanded.reserve(index.size());
  for (const uint32_t i : index) {
    if (i >= rows.size()) return {};
    expanded.push_back(rows[i]);
  }
  return expanded;
}

absl::StatusOr<PolygonMesh> ObjReader::Read() {
  while (scanner_.NextLine()) MARROW_RETURN_IF_ERROR(ReadLine());
  MARROW_RETURN_IF_ERROR(CheckForwardReferences());
  precision_.Apply(&mesh_);
  mesh_.corner_uvs = Expand(uvs_, corner_uv_);
  mesh_.corner_normals = Expand(normals_, corner_normal_);
  return std::move(mesh_);
}

}  // namespace

absl::StatusOr<PolygonMesh> ReadObj(const std::string& path,
                                    std::string_view bytes) {
  return ObjReader(path, bytes).Read();
}

}  // namespace marrow
