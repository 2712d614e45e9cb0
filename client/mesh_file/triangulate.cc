// Ears are clipped here rather than by a library because the usual ones leave
// out corners that lie on a straight line, which would open cracks towards the
// neighbours of the polygon.
#include "client/mesh_file/triangulate.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <span>

namespace marrow {
namespace {

// Clipping takes quadratic time or worse; a larger polygon is cut as a fan.
constexpr size_t kMaxClippedCorners = 1000;

using Point2 = Eigen::Vector2d;

Eigen::Vector3d Position(const PolygonMesh& mesh, uint32_t v) {
  return Eigen::Vector3d(mesh.positions[v].data());
}

// Newell's: twice the area vector, right for polygons that are not quite flat.
Eigen::Vector3d Normal(const PolygonMesh& mesh,
                       std::span<const uint32_t> corners) {
  const Eigen::Vector3d origin = Position(mesh, corners[0]);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += (Position(mesh, corners[i]) - origin)
                  .cross(Position(mesh, corners[i + 1]) - origin);
  }
  return normal;
}

// Drops the axis along which the polygon is thinnest, keeping its turn.
std::vector<Point2> Flatten(const PolygonMesh& mesh,
                            std::span<const uint32_t> corners) {
  const Eigen::Vector3d normal = Normal(mesh, corners);
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  int u = (axis + 1) % 3;
  int v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  std::vector<Point2> points;
  points.reserve(corners.size());
  for (const uint32_t corner : corners) {
    const Eigen::Vector3d position = Position(mesh, corner);
    points.emplace_back(position[u], position[v]);
  }
  return points;
}

// Twice the area of abc, positive where it turns left.
double Turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool Contains(const Point2& a, const Point2& b, const Point2& c,
              const Point2& p) {
  if (p == a || p == b || p == c) return false;
  return Turn(a, b, p) >= 0 && Turn(b, c, p) >= 0 && Turn(c, a, p) >= 0;
}

bool FanIsGood(const std::vector<Point2>& points) {
  for (size_t i = 1; i + 1 < points.size(); ++i) {
    if (!(Turn(points[0], points[i], points[i + 1]) > 0)) return false;
  }
  return true;
}

// Whether the corner at place i of the ring may be cut off.
bool IsEar(const std::vector<Point2>& points, const std::vector<size_t>& ring,
           size_t i) {
  const size_t n = ring.size();
  const Point2& a = points[ring[(i + n - 1) % n]];
  const Point2& b = points[ring[i]];
  const Point2& c = points[ring[(i + 1) % n]];
  if (!(Turn(a, b, c) > 0)) return false;
  for (const size_t other : ring) {
    if (Contains(a, b, c, points[other])) return false;
  }
  return true;
}

// The first ear after place `from`; where there is none (the polygon is flat or
// crosses itself), that place.
size_t FindEar(const std::vector<Point2>& points,
               const std::vector<size_t>& ring, size_t from) {
  for (size_t k = 0; k < ring.size(); ++k) {
    const size_t i = (from + k) % ring.size();
    if (IsEar(points, ring, i)) return i;
  }
  return from % ring.size();
}

void ClipEars(std::span<const uint32_t> corners,
              const std::vector<Point2>& points,
              std::vector<std::array<uint32_t, 3>>* triangles) {
  std::vector<size_t> ring(corners.size());
  for (size_t i = 0; i < ring.size(); ++i) ring[i] = i;
  size_t ear = 1;
  while (ring.size() > 2) {
    const size_t n = ring.size();
    ear = n == 3 ? 1 : FindEar(points, ring, ear);
    triangles->push_back({corners[ring[(ear + n - 1) % n]], corners[ring[ear]],
                          corners[ring[(ear + 1) % n]]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
  }
}

void CutFan(std::span<const uint32_t> corners,
            std::vector<std::array<uint32_t, 3>>* triangles) {
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    triangles->push_back({corners[0], corners[i], corners[i + 1]});
  }
}

}  // namespace

void Triangulate(const PolygonMesh& mesh, size_t f,
                 std::vector<std::array<uint32_t, 3>>* triangles) {
  const std::span<const uint32_t> face = mesh.Face(f);
  if (face.size() <= 3) return CutFan(face, triangles);
  // From the corner with the least position: a face that is there twice, once
  // from behind, is cut along the same lines.
  std::vector<uint32_t> corners(face.begin(), face.end());
  std::rotate(corners.begin(),
              std::min_element(corners.begin(), corners.end(),
                               [&](uint32_t a, uint32_t b) {
                                 return mesh.positions[a] < mesh.positions[b];
                               }),
              corners.end());
  if (corners.size() > kMaxClippedCorners) return CutFan(corners, triangles);
  const std::vector<Point2> points = Flatten(mesh, corners);
  if (FanIsGood(points)) return CutFan(corners, triangles);
  ClipEars(corners, points, triangles);
}

}  // namespace marrow
