// Where the points of a payload are: points at one position are one spot.
#ifndef MARROW_CORE_MESH_SPOTS_H_
#define MARROW_CORE_MESH_SPOTS_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/t_junctions.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// The different positions of a payload in canonical order, called spots until
// it is known which of them are vertices.
struct Spots {
  Positions positions;
  std::vector<uint32_t> of_point;
  TJunctions junctions;  // between spots
};

// Spots in the Z-order of Morton, by the coordinate that differs in the highest
// bit, x before y before z; no junctions yet. REQUIRES: finite coordinates.
// Errors: CANCELLED.
absl::StatusOr<Spots> Weld(const Positions& points, const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_SPOTS_H_
