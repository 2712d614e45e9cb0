// Bridges between the connected components of a mesh, so that a creature made
// of several shells is one body to the operator.
//
// All functions are deterministic and take about O(n log^2 n) where, as in a
// canonical mesh, no two vertices share their place. Components are connected
// through shared vertices. What they give is of no use once cancelled. Thread
// safe.
#ifndef MARROW_CORE_OPERATORS_BRIDGES_H_
#define MARROW_CORE_OPERATORS_BRIDGES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Two vertices of different components, the lesser first.
using Bridge = std::array<uint32_t, 2>;

// The weight of a bridge in L. A vertex of a near zone is the end of about two,
// its own and another's, and across a seam two edges of equilateral triangles
// would conduct 2 / sqrt(3).
inline constexpr double kBridgeWeight = 0.5;

// How far apart two shells may be and still conduct as if they touched: the
// mean edge, but at least a hundredth and at most three hundredths of the
// diagonal of the box. In units of the positions.
double BridgingDistance(const TriangleMesh& mesh);

// A minimum spanning tree of the components by the distance of their nearest
// points, vertices and some inside coarse faces (surface_points.h), for which
// their corners stand, without the bridges longer than `longest`, in units of
// the positions (Boruvka's rounds over a k-d tree). Of equally near pairs the
// least counts. Ascending; empty for a mesh in one piece.
std::vector<Bridge> SpanningBridges(const TriangleMesh& mesh, double longest,
                                    const CancelToken& cancel = CancelToken());

// What the operator adds: the whole spanning tree, and a bridge from every
// point to the nearest point of another component within BridgingDistance().
// So two shells share as many bridges as the zone where they are near has
// vertices, and a limb that is a shell of its own conducts as one that has
// grown on. Ascending.
std::vector<Bridge> FindBridges(const TriangleMesh& mesh,
                                const CancelToken& cancel = CancelToken());

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_BRIDGES_H_
