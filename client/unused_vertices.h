// What a server would tell of vertices that no face uses, had they been sent.
#ifndef MARROW_CLIENT_UNUSED_VERTICES_H_
#define MARROW_CLIENT_UNUSED_VERTICES_H_

#include <cstdint>

#include "marrow/v1/mesh.pb.h"
#include "marrow/v1/segmentation_service.pb.h"

namespace marrow::client {

// Makes the report count the file's unused vertices, and tell of them in a
// finding. False where it counts as many already, as of a file that is sent as
// it is: then nothing is changed.
bool CountUnusedVertices(uint32_t count, v1::MeshReport& report);

// The warning to a report that was changed.
v1::Warning UnusedVerticesWarning(uint32_t count);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_UNUSED_VERTICES_H_
