// The segments of a cut as objects of their own.
#ifndef MARROW_CLIENT_EXPORTERS_OBJ_FILE_H_
#define MARROW_CLIENT_EXPORTERS_OBJ_FILE_H_

#include <cstdint>
#include <span>
#include <string>

#include "absl/status/statusor.h"
#include "client/polygon_mesh.h"

namespace marrow {

// A Wavefront OBJ with one object `segment_<label>` a segment, in ascending
// order of labels. Faces stay polygons and keep the mesh's order within their
// object. Vertices are shared within an object and never between two.
// Coordinates read back as the same floats. Vertices that no face uses and
// faces of fewer than three corners are left out.
//
// InvalidArgument unless there is one label a face.
absl::StatusOr<std::string> PartsObjFile(const PolygonMesh& mesh,
                                         std::span<const uint32_t> face_labels);

}  // namespace marrow

#endif  // MARROW_CLIENT_EXPORTERS_OBJ_FILE_H_
