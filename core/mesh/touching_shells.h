// Closed shells that touch in vertices alone.
#ifndef MARROW_CORE_MESH_TOUCHING_SHELLS_H_
#define MARROW_CORE_MESH_TOUCHING_SHELLS_H_

#include <cstdint>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Shells that meet in a vertex with more than so many are not parted: corners
// of boxes are of eight at most, and what looks for near vertices takes the
// square of those that share a place.
inline constexpr size_t kMostTouching = 8;

struct PartedMesh {
  // The faces in their order, the vertices but for those that are several.
  TriangleMesh mesh;
  std::vector<uint32_t> vertices;  // its vertex -> the other's, not descending
};

// A shell is what edges connect, and closed if none of these has one face. A
// box that stands on another with a coarser grid shares some of its vertices:
// through them the two would conduct less than shells that are merely near
// (core/operators/bridges.h), so every closed shell of at least `least_share`
// has vertices of its own there. Open ones, whose faces may be all that is left
// of one surface, and small ones, the beads of a chain, go on sharing theirs.
// `face_shares`: of the area, one a face. Without vertices where nothing was
// parted. O(n log n), deterministic, thread safe. Of no use once cancelled.
PartedMesh PartTouchingShells(const TriangleMesh& mesh,
                              const std::vector<double>& face_shares,
                              double least_share,
                              const CancelToken& cancel = CancelToken());

}  // namespace marrow

#endif  // MARROW_CORE_MESH_TOUCHING_SHELLS_H_
