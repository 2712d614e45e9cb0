// Positions whose squared distances neither overflow nor vanish.
#ifndef MARROW_CORE_MESH_UNIT_BOX_H_
#define MARROW_CORE_MESH_UNIT_BOX_H_

#include "core/mesh/triangle_mesh.h"

namespace marrow {

struct UnitPoints {
  Positions points;
  double unit = 1;  // of the positions in the mesh's
};

// Moved and scaled so that the box around them begins at the origin and its
// longest side is 1. REQUIRES: two positions, and a finite
// extent.
inline UnitPoints ToUnitBox(const TriangleMesh& mesh) {
  UnitPoints result{mesh.positions};
  const Eigen::RowVector3d low = result.points.colwise().minCoeff();
  result.points.rowwise() -= low;
  result.unit = result.points.maxCoeff();
  result.points /= result.unit;
  return result;
}

}  // namespace marrow

#endif  // MARROW_CORE_MESH_UNIT_BOX_H_
