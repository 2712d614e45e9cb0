// Cracks: rims that are one but for rounding.
#ifndef MARROW_CORE_MESH_CRACKS_H_
#define MARROW_CORE_MESH_CRACKS_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Vertex -> the least of those that it is one with, itself where there are
// none. Vertices of rims (edges of one face) are one where they are nearer than
// 1e-5 of the longest side of the box and than a tenth of the shortest edge at
// either: what programs leave that write corners apart, and round them.
//
// A soup is a mesh whose faces have three of four sides on rims, and nearly all
// of whose vertices there are near to another, within a twentieth of the
// shortest edge at either: what is left open of one would leave a sieve, so in
// a soup all of that is one.
//
// Deterministic, O(n log n), thread safe. Errors: CANCELLED.
absl::StatusOr<std::vector<uint32_t>> FindCracks(const TriangleMesh& mesh,
                                                 const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_CRACKS_H_
