// Ears are clipped here rather than by a library because the usual ones leave
// out corners that lie on a straight line, which would open cracks towards the
// neighbours of the polygon.
#include "client/mesh_file/triangulate.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <set>
#include <span>

namespace marrow {
namespace {

constexpr size_t kNone = std::numeric_limits<size_t>::max();

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

struct Box {
  Point2 low = Point2::Constant(std::numeric_limits<double>::infinity());
  Point2 high = -low;

  // In this order of arguments a NaN changes nothing.
  void Add(const Point2& from, const Point2& to) {
    for (int axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], from[axis]);
      high[axis] = std::max(high[axis], to[axis]);
    }
  }
  bool Meets(const Box& other) const {
    return (low.array() <= other.high.array()).all() &&
           (other.low.array() <= high.array()).all();
  }
  // Whether all of it turns right of ab. Rounding is monotone, so no point for
  // which Turn() is not negative is missed.
  bool IsRightOf(const Point2& a, const Point2& b) const {
    const Point2 leftmost(b.y() > a.y() ? low.x() : high.x(),
                          b.x() > a.x() ? high.y() : low.y());
    return Turn(a, b, leftmost) < 0;
  }
};

// The corners that are left, in a binary tree of boxes over their order in the
// polygon: what lies close together there mostly does in the plane.
class CornerTree {
 public:
  explicit CornerTree(const std::vector<Point2>& points)
      : points_(points),
        num_leaves_(std::bit_ceil(points.size())),
        boxes_(2 * num_leaves_) {
    for (size_t i = 0; i < points.size(); ++i) {
      boxes_[num_leaves_ + i].Add(points[i], points[i]);
    }
    for (size_t node = num_leaves_ - 1; node > 0; --node) Enclose(node);
  }

  void Remove(size_t i) {
    size_t node = num_leaves_ + i;
    boxes_[node] = Box();
    while ((node /= 2) > 0) Enclose(node);
  }

  // The first corner in the triangle abc; kNone where there is none.
  size_t FindIn(const Point2& a, const Point2& b, const Point2& c) const {
    Box box;
    for (const Point2& corner : {a, b, c}) box.Add(corner, corner);
    return FindIn(a, b, c, box, 1);
  }

 private:
  void Enclose(size_t node) {
    boxes_[node] = boxes_[2 * node];
    boxes_[node].Add(boxes_[2 * node + 1].low, boxes_[2 * node + 1].high);
  }

  size_t FindIn(const Point2& a, const Point2& b, const Point2& c,
                const Box& box, size_t node) const {
    const Box& here = boxes_[node];
    if (!here.Meets(box) || here.IsRightOf(a, b) || here.IsRightOf(b, c) ||
        here.IsRightOf(c, a)) {
      return kNone;
    }
    if (node >= num_leaves_) {
      const size_t i = node - num_leaves_;
      return Contains(a, b, c, points_[i]) ? i : kNone;
    }
    const size_t found = FindIn(a, b, c, box, 2 * node);
    return found != kNone ? found : FindIn(a, b, c, box, 2 * node + 1);
  }

  const std::vector<Point2>& points_;
  const size_t num_leaves_;
  std::vector<Box> boxes_;  // 1 is the root, the children of k are 2k and 2k+1
};

// A corner that is found to be no ear is looked at again only when a neighbour
// of it, or the corner that was in its way, is gone.
class EarClipper {
 public:
  EarClipper(std::span<const uint32_t> corners,
             const std::vector<Point2>& points,
             std::vector<std::array<uint32_t, 3>>* triangles)
      : corners_(corners),
        points_(points),
        triangles_(*triangles),
        tree_(points),
        before_(corners.size()),
        after_(corners.size()),
        blocked_(corners.size()) {
    const size_t n = corners.size();
    for (size_t i = 0; i < n; ++i) {
      before_[i] = (i + n - 1) % n;
      after_[i] = (i + 1) % n;
      unknown_.insert(unknown_.end(), i);
    }
  }

  void Clip() {
    size_t at = 1;
    for (size_t left = corners_.size(); left > 3; --left) {
      const size_t ear = FindEar(at);
      Emit(ear);
      at = after_[ear];
      Remove(ear);
    }
    Emit(after_[std::min({before_[at], at, after_[at]})]);
  }

 private:
  // The first ear from corner `from` on; where there is none (the polygon is
  // flat or crosses itself), that corner.
  size_t FindEar(size_t from) {
    while (!unknown_.empty()) {
      auto it = unknown_.lower_bound(from);
      if (it == unknown_.end()) it = unknown_.begin();
      if (IsEar(*it)) return *it;
      unknown_.erase(it);
    }
    return from;
  }

  bool IsEar(size_t i) {
    const Point2& a = points_[before_[i]];
    const Point2& b = points_[i];
    const Point2& c = points_[after_[i]];
    if (!(Turn(a, b, c) > 0)) return false;
    const size_t blocker = tree_.FindIn(a, b, c);
    if (blocker != kNone) blocked_[blocker].push_back(i);
    return blocker == kNone;
  }

  void Emit(size_t i) {
    triangles_.push_back(
        {corners_[before_[i]], corners_[i], corners_[after_[i]]});
  }

  void Remove(size_t i) {
    tree_.Remove(i);
    unknown_.erase(i);
    unknown_.insert({before_[i], after_[i]});
    after_[before_[i]] = after_[i];
    before_[after_[i]] = before_[i];
    after_[i] = kNone;
    for (const size_t other : blocked_[i]) {
      if (after_[other] != kNone) unknown_.insert(other);
    }
  }

  const std::span<const uint32_t> corners_;
  const std::vector<Point2>& points_;
  std::vector<std::array<uint32_t, 3>>& triangles_;
  CornerTree tree_;
  std::vector<size_t> before_;                // of those that are left
  std::vector<size_t> after_;                 // kNone for one that is gone
  std::set<size_t> unknown_;                  // those that may be ears
  std::vector<std::vector<size_t>> blocked_;  // by each corner
};

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
  const std::vector<Point2> points = Flatten(mesh, corners);
  if (FanIsGood(points)) return CutFan(corners, triangles);
  EarClipper(corners, points, triangles).Clip();
}

}  // namespace marrow
