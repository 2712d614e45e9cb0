// A k-d tree over some vertices of a mesh.
#ifndef MARROW_CORE_MESH_VERTEX_CLOUD_H_
#define MARROW_CORE_MESH_VERTEX_CLOUD_H_

#include <cstddef>
#include <cstdint>
#include <nanoflann.hpp>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

// nanoflann's view of the vertices; its indices are those into `vertices`. The
// referents must outlive it.
struct VertexCloud {
  const Positions& points;
  const std::vector<uint32_t>& vertices;

  size_t kdtree_get_point_count() const { return vertices.size(); }
  double kdtree_get_pt(size_t i, size_t d) const {
    return points(vertices[i], d);
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using VertexTree = nanoflann::KDTreeSingleIndexAdaptor<
    nanoflann::L2_Simple_Adaptor<double, VertexCloud>, VertexCloud, 3>;

}  // namespace marrow

#endif  // MARROW_CORE_MESH_VERTEX_CLOUD_H_
