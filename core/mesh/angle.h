// The angle between two vectors.
#ifndef MARROW_CORE_MESH_ANGLE_H_
#define MARROW_CORE_MESH_ANGLE_H_

#include <Eigen/Dense>
#include <cmath>

namespace marrow {

// 0 to pi, stable near both; 0 where one vector is 0.
inline double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace marrow

#endif  // MARROW_CORE_MESH_ANGLE_H_
