// Whether a cut is one loop around a limb or pieces of several seams.
#ifndef MARROW_CORE_BOUNDARIES_LOOPS_H_
#define MARROW_CORE_BOUNDARIES_LOOPS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// The share of the edges' length that their longest connected part has; 0 where
// they have none. Edges that end on one rim are connected, for a cut that runs
// into a hole goes on where it leaves it. `rim_of_vertex` as RimOfVertices()
// gives it.
double LargestLoopShare(const Adjacency& adjacency, const Positions& positions,
                        const std::vector<uint32_t>& rim_of_vertex,
                        std::span<const uint32_t> edges);

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_LOOPS_H_
