// Bridges between the connected components of a mesh, so that a creature made
// of several shells is one body to the operator.
#ifndef MARROW_CORE_OPERATORS_BRIDGES_H_
#define MARROW_CORE_OPERATORS_BRIDGES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Pairs of vertices that join the components into one: a minimum spanning tree
// of the components by the distance of their nearest vertices (Boruvka's
// rounds over a k-d tree). Of equally near pairs the least counts. Empty for a
// mesh in one piece. Deterministic. About O(n log^2 n) where, as in a canonical
// mesh, no two vertices share their place.
std::vector<std::array<uint32_t, 2>> FindBridges(const TriangleMesh& mesh);

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_BRIDGES_H_
