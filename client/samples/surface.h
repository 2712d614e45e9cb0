// Small questions about a triangle surface and its field.
#ifndef MARROW_CLIENT_SAMPLES_SURFACE_H_
#define MARROW_CLIENT_SAMPLES_SURFACE_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "client/samples/field.h"
#include "client/samples/polygonize.h"

namespace marrow {

inline bool Holds(const std::array<uint32_t, 3>& face, uint32_t vertex) {
  return std::find(face.begin(), face.end(), vertex) != face.end();
}

// Twice the area, along the normal.
inline Eigen::Vector3d AreaVector(const std::vector<Eigen::Vector3d>& positions,
                                  const std::array<uint32_t, 3>& face) {
  const Eigen::Vector3d& p = positions[face[0]];
  return (positions[face[1]] - p).cross(positions[face[2]] - p);
}

// The faces at every vertex, ascending.
inline std::vector<std::vector<uint32_t>> FacesOfVertices(
    const SurfaceMesh& mesh) {
  std::vector<std::vector<uint32_t>> result(mesh.positions.size());
  for (uint32_t f = 0; f < mesh.faces.size(); ++f) {
    for (uint32_t v : mesh.faces[f]) result[v].push_back(f);
  }
  return result;
}

// A Newton step from a point near the surface.
inline Eigen::Vector3d OntoSurface(const CreatureField& field,
                                   const Eigen::Vector3d& p) {
  const FieldSample sample = field.At(p);
  return p - sample.gradient *
                 (sample.value / std::max(sample.gradient.squaredNorm(), 0.25));
}

}  // namespace marrow

#endif  // MARROW_CLIENT_SAMPLES_SURFACE_H_
