#include "client/mesh_file/mesh_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <deque>
#include <exception>
#include <filesystem>
#include <iterator>
#include <limits>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/mesh_file/readers.h"
#include "client/mesh_file/text_scanner.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

constexpr uint64_t kMaxFileBytes = uint64_t{4} << 30;
// Of what does not tell its size, such as a pipe or an endless device.
constexpr uint64_t kMaxStreamBytes = uint64_t{1} << 30;

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

absl::Status TooLarge(const std::string& path, uint64_t limit) {
  return absl::ResourceExhaustedError(absl::StrCat(
      path, ": is larger than ", limit >> 30, " GiB; simplify the mesh"));
}

// A file that is read from beginning to end, until a deadline.
class Reading {
 public:
  Reading(const std::string& path, int fd, absl::Time deadline)
      : path_(path), fd_(fd), deadline_(deadline) {}

  absl::StatusOr<std::string> All() {
    struct stat info;
    if (fstat(fd_, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size <= 0) {
      return Stream();
    }
    const auto size = static_cast<uint64_t>(info.st_size);
    if (size > kMaxFileBytes) return TooLarge(path_, kMaxFileBytes);
    return Block(size);
  }

 private:
  // Blocks to the end of what has no size. One string that grew would be there
  // twice each time it did.
  absl::StatusOr<std::string> Stream() {
    constexpr size_t kBlockBytes = size_t{4} << 20;
    std::deque<std::string> blocks;
    uint64_t size = 0;
    do {
      MARROW_ASSIGN_OR_RETURN(blocks.emplace_back(), Block(kBlockBytes));
      size += blocks.back().size();
      if (size > kMaxStreamBytes) return TooLarge(path_, kMaxStreamBytes);
    } while (blocks.back().size() == kBlockBytes);
    std::string bytes;
    bytes.reserve(size);
    for (; !blocks.empty(); blocks.pop_front()) bytes += blocks.front();
    return bytes;
  }

  // `size` bytes, fewer at the end of the file.
  absl::StatusOr<std::string> Block(size_t size) {
    std::string bytes(size, '\0');
    size_t filled = 0;
    while (filled < size) {
      MARROW_RETURN_IF_ERROR(WaitForBytes());
      const ssize_t got = read(fd_, bytes.data() + filled, size - filled);
      if (got == 0) break;
      if (got < 0 && errno != EINTR && errno != EAGAIN) {
        return ReadError(path_, errno);
      }
      filled += got > 0 ? static_cast<size_t>(got) : 0;
    }
    bytes.resize(filled);
    return bytes;
  }

  // Nobody may ever write into a pipe.
  absl::Status WaitForBytes() const {
    pollfd ready{fd_, POLLIN, 0};
    int found = 0;
    do {
      const absl::Duration left = deadline_ - absl::Now();
      const int64_t most = std::numeric_limits<int>::max();
      found = poll(&ready, 1,
                   left == absl::InfiniteDuration()
                       ? -1
                       : static_cast<int>(std::clamp<int64_t>(
                             absl::ToInt64Milliseconds(left), 0, most)));
    } while (found < 0 && errno == EINTR);
    if (found != 0) return absl::OkStatus();
    return absl::DeadlineExceededError("it is still being read");
  }

  const std::string& path_;
  const int fd_;
  const absl::Time deadline_;
};

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

// Whether an OBJ may begin so.
bool IsObjKeyword(std::string_view token) {
  constexpr std::string_view kKeywords[] = {"v", "vt", "vn",     "f",     "g",
                                            "o", "s",  "usemtl", "mtllib"};
  return std::count(std::begin(kKeywords), std::end(kKeywords), token) > 0;
}

MeshFormat FormatOfContent(const std::string& path, std::string_view bytes) {
  if (bytes.substr(0, 5) == "DRACO") return MeshFormat::kDraco;
  if (bytes.substr(0, 4) == "glTF") return MeshFormat::kGltf;
  // A size is no accident, and the beginning of a binary STL may be any words.
  if (HasSizeOfBinaryStl(bytes)) return MeshFormat::kStl;
  constexpr size_t kBeginningBytes = 4096;
  TextScanner scanner(path, bytes.substr(0, kBeginningBytes));
  const std::string_view first = scanner.NextTokenAcrossLines();
  if (first == "ply") return MeshFormat::kPly;
  if (first == "solid") return MeshFormat::kStl;
  if (EndsWith(first, "OFF")) return MeshFormat::kOff;
  if (IsObjKeyword(first)) return MeshFormat::kObj;
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

absl::StatusOr<std::string> ReadFileBytes(const std::string& path,
                                          absl::Time deadline) {
  // To open a pipe into which nobody writes would take for ever.
  const int fd = path == "-"
                     ? fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                     : open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return ReadError(path, errno);
  absl::StatusOr<std::string> bytes = Reading(path, fd, deadline).All();
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
