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

// Finds the nearest of some faces of a mesh by points that stand for them:
// their corners or their centres, and points inside coarse ones.
class NearestFace {
 public:
  enum class By { kCorners, kCentres };

  // The mesh must outlive this. `faces`: not empty. Points inside are no
  // farther apart than what `near` lets pass (surface_points.h).
  NearestFace(const TriangleMesh& mesh, const std::vector<uint32_t>& faces,
              By by, double near)
      : mesh_(mesh),
        unit_(1 / mesh.positions.cwiseAbs().maxCoeff()),
        places_(mesh.positions * unit_),
        tree_(3, Fill(faces, by, near)) {}

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
    void Add(const Eigen::RowVector3d& place, uint32_t face) {
      places.push_back(place);
      faces.push_back(face);
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

  const Cloud& Fill(const std::vector<uint32_t>& faces, By by, double near) {
    if (by == By::kCorners) {
      AddCorners(faces);
    } else {
      for (uint32_t f : faces) cloud_.Add(CentreOf(f), f);
    }
    TriangleMesh some;
    some.positions = mesh_.positions;
    for (uint32_t f : faces) some.faces.push_back(mesh_.faces[f]);
    const FacePoints inside = PointsInFaces(some, places_, near * unit_);
    for (uint32_t i = 0; i < inside.face.size(); ++i)
      cloud_.Add(inside.places.row(i), faces[inside.face[i]]);
    return cloud_;
  }

  // Each once, for the first face that has it.
  void AddCorners(const std::vector<uint32_t>& faces) {
    std::vector<uint32_t> first(mesh_.NumVertices(), kNoIndex);
    for (size_t i = faces.size(); i-- > 0;)
      for (uint32_t v : mesh_.faces[faces[i]]) first[v] = faces[i];
    for (uint32_t v = 0; v < first.size(); ++v)
      if (first[v] != kNoIndex) cloud_.Add(PlaceOf(v), first[v]);
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
