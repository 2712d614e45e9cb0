// Inner walls: where closed shells lie flush against each other, their faces
// back to back, as boxes or voxels that were put together do.
#ifndef MARROW_CORE_MESH_INNER_WALLS_H_
#define MARROW_CORE_MESH_INNER_WALLS_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// How often the payload has a face, with its corners ascending and the other
// way round.
struct Directions {
  uint32_t ascending = 0;
  uint32_t descending = 0;

  bool AreBoth() const { return ascending > 0 && descending > 0; }
};

// Two of the faces that lie in face f, or the one that does, are its sides: 2 f
// and 2 f + 1, the ascending one first, the second of no matter where there is
// one. As every side, the payload's faces have a direction.
inline uint32_t SideOf(uint32_t face, const Directions& directions,
                       bool descends) {
  return 2 * face + (descends && directions.AreBoth());
}

// Side -> the face that is left beside it, of the same shell where neighbours
// agree on what is outside; kNoIndex for what is no wall. Empty where there are
// no walls.
//
// A panel is what edges of two sides join, unless those lie on each other. Two
// are a wall if they have the same borders and are one face or lie in one
// plane, however either is triangulated and turned. Walls that share edges are
// left out together, if that leaves the surface around them closed: at no edge
// may one wall end alone or one other side be left, and at some edge others
// must be. So a sheet with two faces stays, and so does a shell that is there
// twice.
//
// REQUIRES: faces ascend; directions of each. O(n log n), linear where no edge
// has more than two sides. Deterministic, thread safe. Errors: CANCELLED.
absl::StatusOr<std::vector<uint32_t>> FindInnerWalls(
    const TriangleMesh& mesh, const Adjacency& adjacency,
    const std::vector<Directions>& directions, const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_INNER_WALLS_H_
