// A number a vertex that tells equal ones apart by where they are.
#ifndef MARROW_CORE_MESH_PLACE_FACTORS_H_
#define MARROW_CORE_MESH_PLACE_FACTORS_H_

#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

// For each vertex a factor from 1 / (1 + spread) to 1 + spread. It hangs on the
// shape alone: a mesh that is moved, turned, mirrored or scaled has the same
// ones, but for rounding, whatever its numbering. Neighbours have different
// ones, as if drawn at random; vertices that a symmetry of the mesh takes to
// each other have equal ones.
//
// So what is multiplied by them hardly ever is a tie that rounding or numbering
// would break. All 1 where the mesh has no area. Linear. Thread safe.
std::vector<double> PlaceFactors(const TriangleMesh& mesh, double spread);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_PLACE_FACTORS_H_
