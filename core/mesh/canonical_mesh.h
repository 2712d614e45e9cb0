// Decoded mesh -> welded mesh in canonical order, with the way back.
//
// Everything is computed on the canonical mesh, so the numbering of the file
// cannot matter: equal points are one vertex, vertices are sorted by position
// (x, then y, then z), each face is rotated to begin with its least vertex and
// the faces are sorted.
#ifndef MARROW_CORE_MESH_CANONICAL_MESH_H_
#define MARROW_CORE_MESH_CANONICAL_MESH_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/digest.h"
#include "core/mesh/decode.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Counts are exact. "Decoded" is the payload as it came, the rest describes
// the welded mesh. Lengths and areas are in the payload's units.
struct MeshReport {
  uint64_t decoded_points = 0;
  uint64_t decoded_faces = 0;
  uint64_t vertices = 0;              // after welding, used by a kept face
  uint64_t faces = 0;                 // kept: neither degenerate nor duplicate
  uint64_t welded_points = 0;         // points that fell together with another
  uint64_t unused_points = 0;         // points that no face uses
  uint64_t degenerate_faces = 0;      // two corners at one position; dropped
  uint64_t duplicate_faces = 0;       // same three vertices as another; dropped
  uint64_t zero_area_faces = 0;       // kept, three corners on a line
  uint64_t components = 0;            // connected through shared vertices
  uint64_t boundary_edges = 0;        // in exactly one kept face
  uint64_t boundary_loops = 0;        // connected components of boundary edges
  uint64_t nonmanifold_edges = 0;     // in three or more kept faces
  uint64_t nonmanifold_vertices = 0;  // whose faces are not one fan
  // Vertices - edges + faces.
  int64_t euler_characteristic = 0;
  double area = 0;
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
};

struct CanonicalMesh {
  TriangleMesh mesh;
  // Decoded face -> canonical face. A duplicate has that of its twin, a
  // degenerate face that of a neighbour: a kept face that shares an edge with
  // it, else a vertex, else the nearest; so every entry is a face.
  std::vector<uint32_t> face_map;
  // Decoded point -> canonical vertex; kNoIndex for a point that no kept face
  // has at its position.
  std::vector<uint32_t> point_map;
  MeshReport report;
  Digest geometry_digest;  // of the canonical positions and faces
};

// Errors: INVALID_ARGUMENT with reason MESH_REJECTED where no face is left or
// the area is zero or not finite; the message says which. Deterministic; time
// O(n log n).
absl::StatusOr<CanonicalMesh> Canonicalize(const DecodedMesh& decoded);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_CANONICAL_MESH_H_
