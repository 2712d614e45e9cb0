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
// into a hole goes on where it leaves it. So are those that end on one run of
// the edges `beside`, if that has no more than `longest_gap` of the edges'
// length: two arms that touch in the armpit break the cuts through either, and
// each is one nonetheless. `rim_of_vertex` as RimOfVertices() gives it.
double LargestLoopShare(const Adjacency& adjacency, const Positions& positions,
                        const std::vector<uint32_t>& rim_of_vertex,
                        std::span<const uint32_t> edges,
                        std::span<const uint32_t> beside = {},
                        double longest_gap = 0);

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_LOOPS_H_
