// Triangles from the zero set of a field.
#ifndef MARROW_CLIENT_SAMPLES_POLYGONIZE_H_
#define MARROW_CLIENT_SAMPLES_POLYGONIZE_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "client/samples/field.h"

namespace marrow {

struct SurfaceMesh {
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::array<uint32_t, 3>> faces;  // anticlockwise from outside
};

// Marching tetrahedra over cubes of the side `cell`. The result is closed and
// manifold whatever the field, and knows nothing smaller than a cell; its
// triangles are of any shape.
SurfaceMesh Polygonize(const CreatureField& field, double cell);

}  // namespace marrow

#endif  // MARROW_CLIENT_SAMPLES_POLYGONIZE_H_
