// The face nearest to a place.
#ifndef MARROW_CORE_OPERATORS_NEAREST_FACE_H_
#define MARROW_CORE_OPERATORS_NEAREST_FACE_H_

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <nanoflann.hpp>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/operators/surface_points.h"

namespace marrow {

// Finds the face of the bodies nearest to a place, by their vertices and by
// points inside coarse faces.
class NearestFace {
 public:
  // `face_of_vertex`: a face of the bodies, or kNoIndex. `is_left`, by face:
  // whether it is of none of them. The mesh must outlive this.
  NearestFace(const TriangleMesh& mesh,
              const std::vector<uint32_t>& face_of_vertex,
              const std::vector<bool>& is_left, double near)
      : mesh_(mesh),
        unit_(1 / mesh.positions.cwiseAbs().maxCoeff()),
        places_(mesh.positions * unit_),
        cloud_(places_, face_of_vertex),
        tree_(3, Add(mesh, is_left, near)) {}

  // Places are in units of the largest coordinate.
  Eigen::RowVector3d PlaceOf(uint32_t vertex) const {
    return places_.row(vertex);
  }
  Eigen::RowVector3d CentreOf(uint32_t face) const {
    const auto [u, v, w] = mesh_.faces[face];
    return (places_.row(u) + places_.row(v) + places_.row(w)) / 3;
  }

  struct Found {
    double distance_square;
    Eigen::RowVector3d place;
    uint32_t face;
  };
  Found To(const Eigen::RowVector3d& place) const {
    uint32_t found = 0;
    double distance = std::numeric_limits<double>::infinity();
    tree_.knnSearch(place.data(), 1, &found, &distance);
    return {distance, cloud_.places[found], cloud_.faces[found]};
  }

 private:
  // nanoflann's view of the points.
  struct Cloud {
    Cloud(const Positions& vertices,
          const std::vector<uint32_t>& face_of_vertex) {
      for (uint32_t v = 0; v < face_of_vertex.size(); ++v) {
        if (face_of_vertex[v] == kNoIndex) continue;
        places.push_back(vertices.row(v));
        faces.push_back(face_of_vertex[v]);
      }
    }
    size_t kdtree_get_point_count() const { return places.size(); }
    double kdtree_get_pt(size_t i, size_t d) const { return places[i][d]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }

    std::vector<Eigen::RowVector3d> places;
    std::vector<uint32_t> faces;
  };

  const Cloud& Add(const TriangleMesh& mesh, const std::vector<bool>& is_left,
                   double near) {
    const FacePoints inside = PointsInFaces(mesh, places_, near * unit_);
    for (uint32_t i = 0; i < inside.face.size(); ++i) {
      if (is_left[inside.face[i]]) continue;
      cloud_.places.push_back(inside.places.row(i));
      cloud_.faces.push_back(inside.face[i]);
    }
    return cloud_;
  }

  const TriangleMesh& mesh_;
  // Squares of coordinates must neither overflow nor vanish.
  double unit_;
  Positions places_;
  Cloud cloud_;
  nanoflann::KDTreeSingleIndexAdaptor<
      nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3>
      tree_;
};

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_NEAREST_FACE_H_
