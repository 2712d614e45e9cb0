#include "core/operators/surface_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace marrow {
namespace {

constexpr double kCoarse = 2;  // in units of the distance
constexpr double kSpacing = 2.0 / 3;
// More than so many a vertex, or than so many in all if that is more, are not
// worth the search.
constexpr double kMostAVertex = 4;
constexpr double kMostPoints = 200'000;

// How a face is divided: along its longest edge, and from there to the corner
// across.
struct Grid {
  std::array<uint32_t, 3> corners;  // the longest edge is that of the first two
  double steps = 0;                 // along the edge
  double rows = 0;                  // up to the corner

  double Count() const { return (steps + 1) * rows; }
};

Grid GridOf(const Triangle& face, const Positions& places, double near) {
  Grid grid;
  double longest = -1;
  for (int i = 0; i < 3; ++i) {
    const uint32_t a = face[i], b = face[(i + 1) % 3];
    const double length = (places.row(a) - places.row(b)).norm();
    if (length <= longest) continue;
    longest = length;
    grid.corners = {a, b, face[(i + 2) % 3]};
  }
  if (!(longest > kCoarse * near)) return grid;
  const Eigen::Vector3d along =
      (places.row(grid.corners[1]) - places.row(grid.corners[0])).transpose();
  const Eigen::Vector3d up =
      (places.row(grid.corners[2]) - places.row(grid.corners[0])).transpose();
  const double height = along.cross(up).norm() / longest;
  grid.steps = std::ceil(longest / (kSpacing * near));
  grid.rows = std::max(1.0, std::ceil(height / (kSpacing * near)));
  return grid;
}

}  // namespace

FacePoints PointsInFaces(const TriangleMesh& mesh, const Positions& places,
                         double near) {
  double count = 0;
  for (const Triangle& face : mesh.faces)
    count += GridOf(face, places, near).Count();
  FacePoints points;
  if (count > std::max(kMostPoints, kMostAVertex * mesh.NumVertices()))
    return points;
  std::vector<Eigen::RowVector3d> found;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const Grid grid = GridOf(mesh.faces[f], places, near);
    const auto [a, b, c] = grid.corners;
    for (int row = 0; row < grid.rows; ++row) {
      const double up = row / grid.rows;
      const double steps = std::ceil(grid.steps * (1 - up));
      for (int step = 0; step <= steps; ++step) {
        const double along = (1 - up) * step / steps;
        found.push_back((1 - up - along) * places.row(a) +
                        along * places.row(b) + up * places.row(c));
        points.face.push_back(f);
        points.corner.push_back(up > 0.5 ? c : along > 0.5 * (1 - up) ? b : a);
      }
    }
  }
  points.places.resize(static_cast<Eigen::Index>(found.size()), 3);
  for (size_t i = 0; i < found.size(); ++i) points.places.row(i) = found[i];
  return points;
}

}  // namespace marrow
