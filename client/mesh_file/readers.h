// The readers behind ParseMesh, one a format. `path` is for messages (and, for
// glTF, to find buffers); `bytes` is the whole file. All errors are
// INVALID_ARGUMENT. A result may have no faces; its indices are in range.
#ifndef MARROW_CLIENT_MESH_FILE_READERS_H_
#define MARROW_CLIENT_MESH_FILE_READERS_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/polygon_mesh.h"

namespace marrow {

absl::StatusOr<PolygonMesh> ReadOff(const std::string& path,
                                    std::string_view bytes);
absl::StatusOr<PolygonMesh> ReadObj(const std::string& path,
                                    std::string_view bytes);
absl::StatusOr<PolygonMesh> ReadPly(const std::string& path,
                                    std::string_view bytes);
absl::StatusOr<PolygonMesh> ReadStl(const std::string& path,
                                    std::string_view bytes);

// Whether these are as many bytes as a binary STL has by its own count of
// triangles, of which there is one at least.
bool HasSizeOfBinaryStl(std::string_view bytes);

absl::StatusOr<PolygonMesh> ReadGltf(const std::string& path,
                                     std::string_view bytes);

}  // namespace marrow

#endif  // MARROW_CLIENT_MESH_FILE_READERS_H_
