// What the caller should know of a mesh that is segmented all the same.
#ifndef MARROW_SERVER_MESH_WARNINGS_H_
#define MARROW_SERVER_MESH_WARNINGS_H_

#include <vector>

#include "core/mesh/mesh_report.h"
#include "marrow/v1/segmentation_service.pb.h"

namespace marrow {

// In a fixed order; empty for a clean mesh in one piece. The codes are those
// that Warning.code documents.
std::vector<v1::Warning> WarningsAbout(const MeshReport& report);

}  // namespace marrow

#endif  // MARROW_SERVER_MESH_WARNINGS_H_
