#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "client/mesh_file/readers.h"
#include "client/mesh_file/text_precision.h"
#include "client/mesh_file/text_scanner.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

// Most files have a vertex a line, and on it may have colours that the header
// tells nothing of. But the format parts its numbers by any white space, with
// as many columns a vertex as the header says; a face ends with its line.
enum class Layout { kLines, kFree };

// Colours and normals are skipped: they follow the coordinates of a vertex and
// the corners on a face's line.
class OffReader {
 public:
  OffReader(const std::string& path, std::string_view text, Layout layout)
      : size_(text.size()), layout_(layout), scanner_(path, text) {}

  // After Read(): whether another layout may be what was meant. Where the first
  // faces were taken for vertices, lines behind the faces make up for them.
  bool IsDoubtful(const absl::Status& status) const {
    return has_edge_count_ && (!status.ok() || (is_uneven_ && has_rest_));
  }

  absl::StatusOr<PolygonMesh> Read() {
    MARROW_RETURN_IF_ERROR(ReadHeader());
    MARROW_RETURN_IF_ERROR(ReadVertices());
    MARROW_RETURN_IF_ERROR(ReadFaces());
    MARROW_RETURN_IF_ERROR(CheckEnd());
    precision_.Apply(&mesh_);
    return std::move(mesh_);
  }

 private:
  absl::Status ReadHeader();
  absl::Status ReadKeyword(std::string_view keyword);
  void FindEdgeCount();
  absl::Status ReadVertices();
  absl::Status ReadVertex(int64_t vertex);
  int CountTokensLeft();
  absl::Status ReadFaces();
  absl::Status ReadFace(int64_t face);
  absl::Status CheckEnd();
  bool IsFaceLine();
  absl::Status ReadCount(std::string_view token, const char* what,
                         int64_t* count);

  const size_t size_;
  const Layout layout_;
  TextScanner scanner_;
  bool has_edge_count_ = false;
  bool is_uneven_ = false;    // not as many columns on every vertex's line
  bool has_rest_ = false;     // lines after the last face
  int more_columns_ = 0;      // of a vertex, by the header
  bool homogeneous_ = false;  // 4OFF: x y z w, and the point is xyz / w
  int64_t num_vertices_ = 0;
  int64_t num_faces_ = 0;
  TextPrecision precision_;
  PolygonMesh mesh_;
};

absl::Status OffReader::ReadKeyword(std::string_view keyword) {
  std::string_view prefix = keyword.substr(0, keyword.size() - 3);
  const auto take = [&prefix](std::string_view flag) {
    if (prefix.substr(0, flag.size()) != flag) return false;
    prefix.remove_prefix(flag.size());
    return true;
  };
  if (take("ST")) more_columns_ += 2;
  if (take("C")) more_columns_ += 4;
  if (take("N")) more_columns_ += 3;
  homogeneous_ = take("4");
  if (!prefix.empty()) {
    return scanner_.Error(absl::StrCat(
        "cannot read the variant ", Quoted(keyword),
        "; save the mesh as plain OFF, with three coordinates a vertex"));
  }
  return absl::OkStatus();
}

absl::Status OffReader::ReadCount(std::string_view token, const char* what,
                                  int64_t* count) {
  if (token == "BINARY") {
    return scanner_.Error("binary OFF is not supported; save it as text");
  }
  // Each vertex and face takes two bytes at the least.
  if (!ParseInt64(token, count) || *count < 0 ||
      static_cast<uint64_t>(*count) > size_) {
    return scanner_.Error(absl::StrCat("the number of ", what, " is ",
                                       Quoted(token),
                                       ", which this file cannot hold"));
  }
  return absl::OkStatus();
}

absl::Status OffReader::ReadHeader() {
  std::string_view token = scanner_.NextTokenAcrossLines();
  if (token.size() >= 3 && token.substr(token.size() - 3) == "OFF") {
    MARROW_RETURN_IF_ERROR(ReadKeyword(token));
    token = scanner_.NextTokenAcrossLines();
  } else if (int64_t count; !ParseInt64(token, &count)) {
    return scanner_.Error(absl::StrCat("begins with ", Quoted(token),
                                       " where an OFF file has 'OFF'"));
  }
  MARROW_RETURN_IF_ERROR(ReadCount(token, "vertices", &num_vertices_));
  MARROW_RETURN_IF_ERROR(
      ReadCount(scanner_.NextTokenAcrossLines(), "faces", &num_faces_));
  FindEdgeCount();
  return absl::OkStatus();
}

// The number of edges tells nothing, and some leave it out. A number alone on
// the line after the other two is it, and not a vertex.
void OffReader::FindEdgeCount() {
  has_edge_count_ = !scanner_.NextToken().empty();
  if (has_edge_count_) return;
  TextScanner ahead = scanner_;
  int64_t edges = 0;
  has_edge_count_ = ParseInt64(ahead.NextTokenAcrossLines(), &edges) &&
                    edges >= 0 && ahead.NextToken().empty();
  if (has_edge_count_) scanner_.NextTokenAcrossLines();
}

absl::Status OffReader::ReadVertices() {
  mesh_.positions.reserve(num_vertices_);
  int columns_left = 0;  // of the first
  for (int64_t v = 0; v < num_vertices_; ++v) {
    if (layout_ == Layout::kLines && !scanner_.NextLine()) {
      return scanner_.Error(absl::StrCat("the file ends after ", v, " of ",
                                         num_vertices_,
                                         " vertices; it may be cut off"));
    }
    MARROW_RETURN_IF_ERROR(ReadVertex(v));
    if (layout_ == Layout::kFree) continue;
    const int left = CountTokensLeft();
    if (v == 0) columns_left = left;
    is_uneven_ |= left != columns_left;
  }
  // Where a number is missing, the first face's would be taken for it.
  if (layout_ == Layout::kFree && !scanner_.NextToken().empty()) {
    return scanner_.Error("the last vertex does not end with its line");
  }
  return absl::OkStatus();
}

// On this line.
int OffReader::CountTokensLeft() {
  int count = 0;
  while (!scanner_.NextToken().empty()) ++count;
  return count;
}

absl::Status OffReader::ReadVertex(int64_t vertex) {
  const int dimension = homogeneous_ ? 4 : 3;
  const int columns =
      dimension + (layout_ == Layout::kFree ? more_columns_ : 0);
  std::array<double, 4> xyzw = {0, 0, 0, 1};
  for (int i = 0; i < columns; ++i) {
    const std::string_view token = scanner_.NextTokenAcrossLines();
    double skipped = 0;
    if (i < dimension ? !precision_.Parse(token, &xyzw[i])
                      : !ParseDouble(token, &skipped)) {
      return scanner_.Error(absl::StrCat("vertex ", vertex, ": ", Quoted(token),
                                         " is not a coordinate"));
    }
  }
  mesh_.positions.push_back(
      {xyzw[0] / xyzw[3], xyzw[1] / xyzw[3], xyzw[2] / xyzw[3]});
  return absl::OkStatus();
}

absl::Status OffReader::ReadFaces() {
  mesh_.face_offsets.reserve(num_faces_ + 1);
  mesh_.face_vertices.reserve(std::min<size_t>(3 * num_faces_, size_ / 2));
  for (int64_t f = 0; f < num_faces_; ++f) {
    if (!scanner_.NextLine()) {
      return scanner_.Error(absl::StrCat("the file ends after ", f, " of ",
                                         num_faces_,
                                         " faces; it may be cut off"));
    }
    MARROW_RETURN_IF_ERROR(ReadFace(f));
  }
  return absl::OkStatus();
}

absl::Status OffReader::ReadFace(int64_t face) {
  int64_t corners = 0;
  const std::string_view count = scanner_.NextToken();
  if (!ParseInt64(count, &corners) || corners < 0) {
    return scanner_.Error(absl::StrCat("face ", face, ": ", Quoted(count),
                                       " is not a number of corners"));
  }
  for (int64_t i = 0; i < corners; ++i) {
    const std::string_view token = scanner_.NextTokenAcrossLines();
    int64_t vertex = 0;
    if (!ParseInt64(token, &vertex)) {
      return scanner_.Error(absl::StrCat("face ", face, ": ", Quoted(token),
                                         " is not a vertex index"));
    }
    if (vertex < 0 || vertex >= num_vertices_) {
      return scanner_.Error(absl::StrCat(
          "vertex index ", vertex, " is out of range (the file has ",
          num_vertices_, " vertices, counted from 0)"));
    }
    mesh_.face_vertices.push_back(static_cast<uint32_t>(vertex));
  }
  mesh_.face_offsets.push_back(
      static_cast<uint32_t>(mesh_.face_vertices.size()));
  return absl::OkStatus();
}

// Whether this line begins as one of a triangle or a larger polygon does.
bool OffReader::IsFaceLine() {
  int64_t corners = 0;
  if (!ParseInt64(scanner_.NextToken(), &corners) || corners < 3) return false;
  for (int64_t i = 0; i < corners; ++i) {
    int64_t vertex = 0;
    if (!ParseInt64(scanner_.NextToken(), &vertex)) return false;
    if (vertex < 0 || vertex >= num_vertices_) return false;
  }
  return true;
}

// Edges and anything else may follow the faces, but no more faces.
absl::Status OffReader::CheckEnd() {
  int64_t found = num_faces_;
  size_t line = 0;  // of the first too many
  while (scanner_.NextLine()) {
    has_rest_ = true;
    if (!IsFaceLine()) continue;
    if (++found == num_faces_ + 1) line = scanner_.line();
  }
  if (found == num_faces_) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      scanner_.path(), ": line ", line, ": the number of faces is ", num_faces_,
      ", but the file has ", found,
      "; mend the number in the header, or take the lines away"));
}

}  // namespace

absl::StatusOr<PolygonMesh> ReadOff(const std::string& path,
                                    std::string_view bytes) {
  OffReader lines(path, bytes, Layout::kLines);
  absl::StatusOr<PolygonMesh> mesh = lines.Read();
  if (!lines.IsDoubtful(mesh.status())) return mesh;
  absl::StatusOr<PolygonMesh> other =
      OffReader(path, bytes, Layout::kFree).Read();
  return other.ok() ? std::move(other) : std::move(mesh);
}

}  // namespace marrow
