// Positions whose squared distances neither overflow nor vanish.
#ifndef MARROW_CORE_MESH_UNIT_BOX_H_
#define MARROW_CORE_MESH_UNIT_BOX_H_

#include <algorithm>
#include <cmath>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

// A power of two that brings the largest coordinate near 1: exact, and squares
// of what it scales neither overflow nor vanish.
inline double UnitScale(const TriangleMesh& mesh) {
  const double largest = mesh.positions.cwiseAbs().maxCoeff();
  if (largest == 0) return 1;
  return std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000));
}

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
