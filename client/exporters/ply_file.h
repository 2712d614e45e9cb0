// A mesh coloured by segment, for MeshLab, Blender and other viewers.
#ifndef MARROW_CLIENT_EXPORTERS_PLY_FILE_H_
#define MARROW_CLIENT_EXPORTERS_PLY_FILE_H_

#include <cstdint>
#include <span>
#include <string>

#include "absl/status/statusor.h"
#include "client/polygon_mesh.h"

namespace marrow {

// A binary little-endian PLY. Faces stay polygons, in the mesh's order, and
// have the colour of their segment; so do vertices, which are split along the
// cuts, so that no colour bleeds over a boundary. Vertices that no face uses
// and faces of fewer than three corners are left out.
//
// InvalidArgument unless there is one label a face.
absl::StatusOr<std::string> PlyFile(const PolygonMesh& mesh,
                                    std::span<const uint32_t> face_labels);

}  // namespace marrow

#endif  // MARROW_CLIENT_EXPORTERS_PLY_FILE_H_
