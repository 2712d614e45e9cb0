// T-junctions: where a corner of one face lies inside an edge of another, so
// that a slit runs between them.
#ifndef MARROW_CORE_MESH_T_JUNCTIONS_H_
#define MARROW_CORE_MESH_T_JUNCTIONS_H_

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Edge, its lesser end first -> the vertices inside it, from that end on.
using TJunctions = std::map<std::array<uint32_t, 2>, std::vector<uint32_t>>;

// The vertices of rims (edges of one face) that lie inside edges of rims: no
// farther from the edge than a thousandth of its length and a tenth of the
// face's height over it, and from its ends no nearer than a fiftieth. Of each
// edge those among the 64 vertices of rims that are nearest to its middle; in
// all no more than the mesh has faces. Deterministic, O(n log n), thread safe.
// Errors: CANCELLED.
absl::StatusOr<TJunctions> FindTJunctions(const TriangleMesh& mesh,
                                          const CancelToken& cancel);

// The faces that a face becomes when its edges are split at the vertices inside
// them, turned as it is; itself where there are none. Together they cover it,
// and each has three corners.
std::vector<Triangle> SplitAt(const TJunctions& junctions,
                              const Triangle& face);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_T_JUNCTIONS_H_
