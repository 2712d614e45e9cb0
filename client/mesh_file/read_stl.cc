#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/mesh_file/readers.h"
#include "client/mesh_file/text_precision.h"
#include "client/mesh_file/text_scanner.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

static_assert(std::endian::native == std::endian::little);

// 80 bytes of anything, the number of triangles, then for each a normal, three
// points and two bytes of anything.
constexpr size_t kHeaderBytes = 84;
constexpr size_t kTriangleBytes = 50;
constexpr size_t kNormalBytes = 12;

bool Is(std::string_view token, const char* keyword) {
  return absl::EqualsIgnoreCase(absl::string_view(token.data(), token.size()),
                                keyword);
}

uint64_t DeclaredBytes(std::string_view bytes) {
  uint32_t triangles = 0;
  std::memcpy(&triangles, bytes.data() + kHeaderBytes - sizeof(triangles),
              sizeof(triangles));
  return kHeaderBytes + uint64_t{kTriangleBytes} * triangles;
}

// Binary files whose header begins with "solid" are common, so the size
// decides before the text does, and so does a byte that no text has.
bool IsBinary(std::string_view bytes) {
  if (HasSizeOfBinaryStl(bytes)) return true;
  if (bytes.substr(0, 1024).find('\0') != std::string_view::npos) return true;
  TextScanner scanner("", bytes.substr(0, kHeaderBytes));
  return !Is(scanner.NextTokenAcrossLines(), "solid");
}

absl::StatusOr<PolygonMesh> ReadBinary(const std::string& path,
                                       std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat(path,
                     ": is neither a text STL (which begins with "
                     "'solid') nor a binary one (",
                     bytes.size(), " bytes are less than its header of 84)"));
  }
  const uint64_t declared = DeclaredBytes(bytes);
  const uint64_t triangles = (declared - kHeaderBytes) / kTriangleBytes;
  if (declared > bytes.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ": byte 80: ", triangles, " triangles take ",
                     declared, " bytes, but the file has ", bytes.size(),
                     "; it is cut off or not an STL"));
  }
  // A few bytes more are padding.
  const uint64_t held = (bytes.size() - kHeaderBytes) / kTriangleBytes;
  if (held > triangles) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ": byte 80: the number of triangles is ", triangles,
                     ", but the file has room for ", held,
                     "; export it anew, or mend the count"));
  }
  if (3 * triangles > 0xFFFFFFFEu) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ": has too many triangles: ", triangles));
  }
  PolygonMesh mesh;
  mesh.positions.resize(3 * triangles);
  for (uint32_t t = 0; t < triangles; ++t) {
    std::array<float, 9> corners;
    std::memcpy(
        corners.data(),
        bytes.data() + kHeaderBytes + size_t{kTriangleBytes} * t + kNormalBytes,
        sizeof(corners));
    for (size_t i = 0; i < 3; ++i) {
      mesh.positions[size_t{3} * t + i] = {corners[3 * i], corners[3 * i + 1],
                                           corners[3 * i + 2]};
    }
    mesh.AddFace(std::array<uint32_t, 3>{3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

absl::Status ReadPoint(TextScanner& scanner, TextPrecision& precision,
                       PolygonMesh* mesh) {
  std::array<double, 3> point;
  for (double& coordinate : point) {
    const std::string_view token = scanner.NextToken();
    if (!precision.Parse(token, &coordinate)) {
      return scanner.Error(absl::StrCat("after 'vertex', ", Quoted(token),
                                        " is not a coordinate"));
    }
  }
  mesh->face_vertices.push_back(static_cast<uint32_t>(mesh->NumVertices()));
  mesh->positions.push_back(point);
  return absl::OkStatus();
}

void CloseFace(PolygonMesh* mesh) {
  mesh->face_offsets.push_back(
      static_cast<uint32_t>(mesh->face_vertices.size()));
}

absl::StatusOr<PolygonMesh> ReadText(const std::string& path,
                                     std::string_view bytes) {
  TextScanner scanner(path, bytes, {.comments = false});
  TextPrecision precision;
  PolygonMesh mesh;
  bool in_facet = false;
  while (scanner.NextLine()) {
    for (std::string_view token = scanner.NextToken(); !token.empty();
         token = scanner.NextToken()) {
      // What follows is a name, which may be any words.
      if (Is(token, "solid") || Is(token, "endsolid")) break;
      if (Is(token, "facet")) in_facet = true;
      if (Is(token, "vertex")) {
        MARROW_RETURN_IF_ERROR(ReadPoint(scanner, precision, &mesh));
      } else if (Is(token, "endfacet")) {
        CloseFace(&mesh);
        in_facet = false;
      }
    }
  }
  if (in_facet || mesh.face_offsets.back() != mesh.face_vertices.size()) {
    return scanner.Error(
        "the file ends within a facet, without 'endfacet'; it may be cut off");
  }
  precision.Apply(&mesh);
  return mesh;
}

}  // namespace

bool HasSizeOfBinaryStl(std::string_view bytes) {
  return bytes.size() > kHeaderBytes && DeclaredBytes(bytes) == bytes.size();
}

absl::StatusOr<PolygonMesh> ReadStl(const std::string& path,
                                    std::string_view bytes) {
  return IsBinary(bytes) ? ReadBinary(path, bytes) : ReadText(path, bytes);
}

}  // namespace marrow
