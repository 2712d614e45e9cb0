// Some faces of a canonical mesh as a canonical mesh of their own.
#ifndef MARROW_CORE_MESH_SUBMESH_H_
#define MARROW_CORE_MESH_SUBMESH_H_

#include <cstdint>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/mesh/canonical_mesh.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

struct Submesh {
  // What Canonicalize() gives for a payload of these faces alone, to the last
  // bit of the digest if they are whole components, else but for which way the
  // faces of a part are turned. No maps; of the report what ReportOn() finds.
  CanonicalMesh canonical;
  std::vector<uint32_t> vertices;  // own vertex -> the mesh's, ascending
};

// `faces` ascending, not empty. `mesh` is canonical. O(n log n). Of no use
// once cancelled. Thread safe.
Submesh ExtractFaces(const TriangleMesh& mesh,
                     const std::vector<uint32_t>& faces,
                     const CancelToken& cancel = CancelToken());

}  // namespace marrow

#endif  // MARROW_CORE_MESH_SUBMESH_H_
