// A triangulated surface, as everything after core/mesh sees it.
#ifndef MARROW_CORE_MESH_TRIANGLE_MESH_H_
#define MARROW_CORE_MESH_TRIANGLE_MESH_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace marrow {

// "No vertex, face or segment has this index."
inline constexpr uint32_t kNoIndex = 0xFFFFFFFFu;

using Triangle = std::array<uint32_t, 3>;
// n x 3, a row a vertex.
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// Immutable once built. Corners are dense vertex ids; a face has three
// different corners, though its area may be zero.
struct TriangleMesh {
  Positions positions;
  std::vector<Triangle> faces;

  uint32_t NumVertices() const {
    return static_cast<uint32_t>(positions.rows());
  }
  uint32_t NumFaces() const { return static_cast<uint32_t>(faces.size()); }
  Eigen::Vector3d Position(uint32_t v) const {
    return positions.row(v).transpose();
  }
};

}  // namespace marrow

#endif  // MARROW_CORE_MESH_TRIANGLE_MESH_H_
