// Rims of different components that face each other, sewn together.
#ifndef MARROW_CORE_OPERATORS_SEAMS_H_
#define MARROW_CORE_OPERATORS_SEAMS_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Vertex -> the least of those that it is to be one with, itself where there
// are none. A rim is what edges of one face connect. A vertex of a rim goes
// with the nearest one of the rims of other components, within `longest`, in
// units of the positions: first those that are nearest to each other, then the
// others; but never two of one component. So limbs that were
// cut off along a joint grow on again, and the surface goes through the joint
// as if it had never been cut. Components are connected through shared
// vertices. Deterministic, O(n log^2 n), thread safe.
// Of no use once cancelled.
std::vector<uint32_t> SewRims(const TriangleMesh& mesh, double longest,
                              const CancelToken& cancel = CancelToken());

// A vertex of a surface has about six corners.
inline constexpr size_t kNearestShreds = 12;

// The same for shreds, where the vertices of six or so make one: of the pairs
// of vertices of rims that are nearer than half of the shortest edge at either,
// the nearest first, by the kNearestShreds nearest ones of each. Errors:
// CANCELLED.
absl::StatusOr<std::vector<uint32_t>> SewShreds(const TriangleMesh& mesh,
                                                const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_SEAMS_H_
