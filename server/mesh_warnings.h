// What is out of the ordinary about a mesh that is segmented all the same.
#ifndef MARROW_SERVER_MESH_WARNINGS_H_
#define MARROW_SERVER_MESH_WARNINGS_H_

#include <vector>

#include "core/mesh/mesh_report.h"
#include "marrow/v1/mesh.pb.h"
#include "marrow/v1/segmentation_service.pb.h"

namespace marrow {

// Everything, with what is done about it, in a fixed order; empty for a clean
// closed mesh in one piece. The codes are those that Finding.code documents.
std::vector<v1::Finding> FindingsAbout(const MeshReport& report);

// The findings that a caller should hear of unasked: ordinary seams, holes,
// slivers and orientation are left out.
std::vector<v1::Warning> WarningsAbout(const MeshReport& report);

}  // namespace marrow

#endif  // MARROW_SERVER_MESH_WARNINGS_H_
