#include "client/mesh_file/mesh_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "client/mesh_file/readers.h"
#include "client/mesh_file/text_scanner.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

// Bounds what an endless file, such as a device, can fill.
constexpr size_t kMaxFileBytes = size_t{4} << 30;

absl::Status ReadError(const std::string& path, int error) {
  const std::string what =
      absl::StrCat(path, ": cannot read: ", std::strerror(error));
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return absl::NotFoundError(absl::StrCat(what, "; check the name"));
    case EACCES:
    case EPERM:
      return absl::PermissionDeniedError(
          absl::StrCat(what, "; check its permissions"));
    case EISDIR:
      return absl::InvalidArgumentError(
          absl::StrCat(path, ": is a folder; name the mesh files in it"));
    default:
      return absl::UnknownError(what);
  }
}

absl::StatusOr<std::string> ReadAll(const std::string& path, int fd) {
  std::string bytes;
  struct stat info;
  if (fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0 &&
      static_cast<uint64_t>(info.st_size) <= kMaxFileBytes) {
    bytes.reserve(static_cast<size_t>(info.st_size) + 1);
  }
  constexpr size_t kChunkBytes = size_t{1} << 20;
  while (true) {
    const size_t size = bytes.size();
    bytes.resize(std::max(size + kChunkBytes, bytes.capacity()));
    const ssize_t got = read(fd, bytes.data() + size, bytes.size() - size);
    const int error = errno;
    bytes.resize(size + (got > 0 ? static_cast<size_t>(got) : 0));
    if (got < 0 && error != EINTR) return ReadError(path, error);
    if (got == 0) return bytes;
    if (bytes.size() > kMaxFileBytes) {
      return absl::ResourceExhaustedError(
          absl::StrCat(path, ": is larger than 4 GiB"));
    }
  }
}

MeshFormat FormatOfExtension(const std::string& path) {
  const std::string extension =
      absl::AsciiStrToLower(std::filesystem::path(path).extension().string());
  if (extension == ".off") return MeshFormat::kOff;
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".stl") return MeshFormat::kStl;
  if (extension == ".gltf" || extension == ".glb") return MeshFormat::kGltf;
  if (extension == ".drc") return MeshFormat::kDraco;
  return MeshFormat::kUnknown;
}

bool EndsWith(std::string_view text, std::string_view end) {
  return text.size() >= end.size() &&
         text.substr(text.size() - end.size()) == end;
}

MeshFormat FormatOfContent(const std::string& path, std::string_view bytes) {
  if (bytes.substr(0, 5) == "DRACO") return MeshFormat::kDraco;
  if (bytes.substr(0, 4) == "glTF") return MeshFormat::kGltf;
  constexpr size_t kBeginningBytes = 4096;
  TextScanner scanner(path, bytes.substr(0, kBeginningBytes));
  const std::string_view first = scanner.NextTokenAcrossLines();
  if (first == "ply") return MeshFormat::kPly;
  if (first == "solid") return MeshFormat::kStl;
  if (EndsWith(first, "OFF")) return MeshFormat::kOff;
  if (first == "v" || first == "o" || first == "g" || first == "mtllib") {
    return MeshFormat::kObj;
  }
  if (first.substr(0, 1) == "{") return MeshFormat::kGltf;
  return MeshFormat::kUnknown;
}

absl::Status UnknownFormatError(const std::string& path) {
  return absl::InvalidArgumentError(absl::StrCat(
      path,
      ": is of no format that can be read; use .off, .obj, .ply, .stl, "
      ".gltf, .glb or .drc"));
}

absl::StatusOr<PolygonMesh> ParseAs(MeshFormat format, const std::string& path,
                                    std::string_view bytes) {
  switch (format) {
    case MeshFormat::kOff:
      return ReadOff(path, bytes);
    case MeshFormat::kObj:
      return ReadObj(path, bytes);
    case MeshFormat::kPly:
      return ReadPly(path, bytes);
    case MeshFormat::kStl:
      return ReadStl(path, bytes);
    case MeshFormat::kGltf:
      return ReadGltf(path, bytes);
    case MeshFormat::kDraco:
      return absl::InvalidArgumentError(absl::StrCat(
          path, ": holds Draco bytes, which are sent as they are"));
    case MeshFormat::kUnknown:
      break;
  }
  return UnknownFormatError(path);
}

}  // namespace

MeshFormat DetectMeshFormat(const std::string& path, std::string_view bytes) {
  const MeshFormat format = FormatOfExtension(path);
  return format != MeshFormat::kUnknown ? format : FormatOfContent(path, bytes);
}

absl::StatusOr<std::string> ReadFileBytes(const std::string& path) {
  const int fd = path == "-" ? fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                             : open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return ReadError(path, errno);
  absl::StatusOr<std::string> bytes = ReadAll(path, fd);
  close(fd);
  if (bytes.ok() && bytes->empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ": is empty; it holds no mesh"));
  }
  return bytes;
}

absl::StatusOr<PolygonMesh> ParseMesh(const std::string& path,
                                      std::string_view bytes) {
  try {
    MARROW_ASSIGN_OR_RETURN(
        PolygonMesh mesh, ParseAs(DetectMeshFormat(path, bytes), path, bytes));
    if (mesh.NumFaces() == 0) {
      // How it begins, which other formats may too, is all there was to go by.
      if (std::filesystem::path(path).has_extension() &&
          FormatOfExtension(path) == MeshFormat::kUnknown) {
        return UnknownFormatError(path);
      }
      return absl::InvalidArgumentError(absl::StrCat(
          path,
          ": has no faces; Marrow needs a surface, so save the mesh with "
          "its faces"));
    }
    return mesh;
  } catch (const std::exception& e) {  // out of memory
    return absl::ResourceExhaustedError(
        absl::StrCat(path, ": cannot be held in memory: ", e.what()));
  }
}

absl::StatusOr<PolygonMesh> ReadMeshFile(const std::string& path) {
  MARROW_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
  return ParseMesh(path, bytes);
}

}  // namespace marrow
