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
  // Face f has the side 2 f and, where the payload has it more than once, the
  // side 2 f + 1; where it has both directions, the ascending one first.
  uint32_t NumSides() const { return ascending + descending > 1 ? 2 : 1; }
};

// Of one of the payload's faces that are face `face`.
inline uint32_t SideOf(uint32_t face, const Directions& directions,
                       bool descends) {
  return 2 * face + (descends && directions.AreBoth());
}

// Side -> a face that is left beside it, mostly of the same shell; kNoIndex for
// what is no wall. Empty where there are no walls.
//
// A panel is what edges of two sides join, unless those lie on each other. Two
// are a wall if they have the same borders in opposite directions and are one
// face or lie in one plane, however either is triangulated. Walls that share
// edges are left out together, if the surface around them stays closed and they
// are inside of it: at no edge may one wall end alone or one other side be
// left, at some edge two must be, and wherever two are, the walls there lie
// behind them. So a sheet with two faces stays, and so do a hat of two sides
// and a shell that is there twice. Where shells disagree on what is outside,
// walls stay.
//
// REQUIRES: faces ascend; directions of each. O(n log n), linear where no edge
// has more than two sides. Deterministic, thread safe. Errors: CANCELLED.
absl::StatusOr<std::vector<uint32_t>> FindInnerWalls(
    const TriangleMesh& mesh, const Adjacency& adjacency,
    const std::vector<Directions>& directions, const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_INNER_WALLS_H_
