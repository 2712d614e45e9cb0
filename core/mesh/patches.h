// Patches over the holes of a surface.
#ifndef MARROW_CORE_MESH_PATCHES_H_
#define MARROW_CORE_MESH_PATCHES_H_

#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// A hole has at most so many edges, and is at most so long, by the square root
// of the mesh's area: around a finger. On a coarse mesh it may be longer, by
// the mean edge of rims: what a vertex leaves with the faces around it.
inline constexpr uint32_t kMostHoleEdges = 24;
inline constexpr double kLongestHole = 0.2;
inline constexpr double kLongestInEdges = 8;

// Faces that fill the small holes of a mesh, ascending; they have its vertices
// and no others. A rim is followed from gap to gap: where several fans of faces
// meet in a vertex, the gaps between them are told apart by their order around
// it, so holes that touch in a vertex are holes of their own. What comes back
// to its beginning without meeting a vertex twice is the rim of a hole, unless
// its component is hardly larger than what would fill it, or the piece, by
// edges, that has all of it: then it is an outline. Of all ways to fill one,
// that of the least area which takes no edge that is there already.
//
// Deterministic, O(n log n), thread safe. Errors: CANCELLED.
absl::StatusOr<std::vector<Triangle>> PatchHoles(const TriangleMesh& mesh,
                                                 const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_PATCHES_H_
