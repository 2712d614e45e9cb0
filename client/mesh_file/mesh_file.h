// Mesh files of many formats -> PolygonMesh and back.
#ifndef MARROW_CLIENT_MESH_FILE_MESH_FILE_H_
#define MARROW_CLIENT_MESH_FILE_MESH_FILE_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/polygon_mesh.h"

namespace marrow {

enum class MeshFormat { kUnknown, kOff, kObj, kPly, kStl, kGltf, kDraco };

// By the extension of `path`, in either case; where that says nothing, by how
// `bytes` begin, and by how many a binary STL has.
MeshFormat DetectMeshFormat(const std::string& path, std::string_view bytes);

// The whole file; of "-", standard input to its end. Errors name the path:
// NOT_FOUND, PERMISSION_DENIED, INVALID_ARGUMENT (a folder, an empty file),
// RESOURCE_EXHAUSTED (over 4 GiB; over 1 GiB of what is no regular file);
// DEADLINE_EXCEEDED does not.
absl::StatusOr<std::string> ReadFileBytes(
    const std::string& path, absl::Time deadline = absl::InfiniteFuture());

// Reads an OFF, OBJ, PLY, STL, glTF or GLB file.
//
// Vertices and faces come in the file's order and number, degenerate and
// repeated ones too; an STL has three vertices a face. The faces of a glTF come
// in node, primitive, index order: the scene's nodes are walked depth first,
// each with its transform. The mesh has at least one face, and every index is
// in range. Numbers are read without regard to the locale and rounded
// correctly; "nan" and "inf" are numbers. Positions are doubles where the file
// has them: a PLY by its types, a text by its digits (text_precision.h).
//
// Errors are those of ReadFileBytes and INVALID_ARGUMENT, whose message names
// the file, the line or element, and what would help.
absl::StatusOr<PolygonMesh> ReadMeshFile(const std::string& path);

// The same for bytes that were read before; `path` gives the format and the
// name for messages, and the folder in which a glTF finds its buffers.
absl::StatusOr<PolygonMesh> ParseMesh(const std::string& path,
                                      std::string_view bytes);

// Writes .off, .obj, .ply (binary) or .stl (binary, polygons triangulated), as
// the extension says, whole or not at all. Positions are written so that they
// read back as the same numbers, but that an STL holds floats alone. Texture
// coordinates and normals are not written. Errors: INVALID_ARGUMENT for another
// extension or a mesh that the format cannot hold, and those of
// WriteFileAtomically.
absl::Status WriteMesh(const PolygonMesh& mesh, const std::string& path);

}  // namespace marrow

#endif  // MARROW_CLIENT_MESH_FILE_MESH_FILE_H_
