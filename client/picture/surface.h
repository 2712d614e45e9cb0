// The drawable part of a mesh: triangles of a common size with normals.
#ifndef MARROW_CLIENT_PICTURE_SURFACE_H_
#define MARROW_CLIENT_PICTURE_SURFACE_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "client/polygon_mesh.h"

namespace marrow {

struct Surface {
  // Corners of triangles, welded by position and moved so that the bounding
  // box has its centre at 0 and its longest side is 2.
  std::vector<Eigen::Vector3f> points;
  // Unit normals of the points, averaged over triangles by their angle; 0 where
  // they cancel.
  std::vector<Eigen::Vector3f> normals;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint32_t> labels;  // one a triangle

  // What moved the file's positions: (position - center) * scale.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double scale = 1;

  Eigen::Vector3f Place(const std::array<double, 3>& position) const {
    return ((Eigen::Vector3d(position[0], position[1], position[2]) - center) *
            scale)
        .cast<float>();
  }
};

// REQUIRES: one label a face. Polygons are cut into fans; faces with a corner
// that is not finite are left out.
Surface MakeSurface(const PolygonMesh& mesh,
                    std::span<const uint32_t> face_labels);

}  // namespace marrow

#endif  // MARROW_CLIENT_PICTURE_SURFACE_H_
