// Decoded mesh -> welded mesh in canonical order, with the way back.
//
// Everything is computed on the canonical mesh, so neither the numbering of the
// file can matter nor which way its faces are turned: equal points are one
// vertex (-0 equals 0), and so are points on either side of a crack
// (core/mesh/cracks.h), vertices are sorted by position, each face is rotated
// to begin with its least vertex and the faces are sorted. Positions are sorted
// along the Z-order curve of their coordinates as binary numbers: what is near
// in number is near on the surface, mostly, and a part of a mesh has its
// vertices in the order that they have alone. Of faces with the same vertices
// one is kept, none of walls inside of shells that lie flush against each other
// (core/mesh/inner_walls.h), and faces agree, outwards, where they can
// (FacesInward()).
#ifndef MARROW_CORE_MESH_CANONICAL_MESH_H_
#define MARROW_CORE_MESH_CANONICAL_MESH_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/base/digest.h"
#include "core/mesh/decode.h"
#include "core/mesh/mesh_report.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

struct CanonicalMesh {
  TriangleMesh mesh;
  // Decoded face -> canonical face. A duplicate has that of its twin, a face of
  // an inner wall that beside it, a degenerate face that of a neighbour: the
  // first face that shares its edge, else its lesser vertex, else the first of
  // the nearer of the two vertices between which its lesser corner would be
  // sorted. So every entry is a face.
  std::vector<uint32_t> face_map;
  // Decoded point -> canonical vertex; kNoIndex for a point that no kept face
  // has at its position.
  std::vector<uint32_t> point_map;
  MeshReport report;
  // Of the counts, the positions and the faces, in the canonical order.
  Digest geometry_digest;
};

// Errors: INVALID_ARGUMENT with reason MESH_REJECTED where no face is left or
// the area is zero, not finite, or under 1e-30 of the squared extent; the
// message says which; CANCELLED. REQUIRES:
// positions are finite and face indices are points. Deterministic; time
// O(n log n). Thread safe.
absl::StatusOr<CanonicalMesh> Canonicalize(
    const DecodedMesh& decoded, const CancelToken& cancel = CancelToken());

// The digest of a mesh that is in canonical order. Thread safe.
Digest GeometryDigestOf(const TriangleMesh& mesh);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_CANONICAL_MESH_H_
