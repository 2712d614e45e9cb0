// Whether a cut is one loop around a limb or pieces of several seams.
#ifndef MARROW_CORE_BOUNDARIES_LOOPS_H_
#define MARROW_CORE_BOUNDARIES_LOOPS_H_

#include <cstdint>
#include <span>

#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// The share of the edges' length that their longest connected part has; 0 where
// they have none.
double LargestLoopShare(const Adjacency& adjacency, const Positions& positions,
                        std::span<const uint32_t> edges);

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_LOOPS_H_
