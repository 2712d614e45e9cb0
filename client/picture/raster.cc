#include "client/picture/raster.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace marrow {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Triangle = std::array<uint32_t, 3>;

// A triangle as edge functions and a plane of depth. Edge i is
// a[i] x + b[i] y + c[i], not negative inside.
struct Setup {
  std::array<double, 3> a, b, c;
  double dzdx, dzdy, z0;
  float z_min, z_max;
  int first_row, last_row;
};

// First and last sample whose centre lies in [low, high], cut to 0..size - 1.
std::pair<int, int> SampleRange(double low, double high, int size) {
  const double first = std::ceil(std::max(low - 0.5, 0.0));
  const double last = std::floor(std::min(high - 0.5, size - 1.0));
  if (!(first <= last)) return {0, -1};
  return {static_cast<int>(first), static_cast<int>(last)};
}

// False for a triangle that is seen edge-on or between the samples' rows.
bool SetUp(const std::array<Vector3d, 3>& p, int height, Setup& s) {
  const double area = (p[1] - p[0]).head<2>().x() * (p[2] - p[0]).y() -
                      (p[2] - p[0]).x() * (p[1] - p[0]).y();
  if (!(std::abs(area) > 1e-9)) return false;
  const auto [y_min, y_max] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
  std::tie(s.first_row, s.last_row) = SampleRange(y_min, y_max, height);
  if (s.first_row > s.last_row) return false;
  const double sign = area > 0 ? 1 : -1;
  for (int i = 0; i < 3; ++i) {
    const Vector3d& from = p[(i + 1) % 3];
    const Vector3d& to = p[(i + 2) % 3];
    s.a[i] = sign * (from.y() - to.y());
    s.b[i] = sign * (to.x() - from.x());
    s.c[i] = -(s.a[i] * from.x() + s.b[i] * from.y());
  }
  const double scale = 1 / std::abs(area);
  s.dzdx = s.dzdy = s.z0 = 0;
  for (int i = 0; i < 3; ++i) {
    s.dzdx += s.a[i] * scale * p[i].z();
    s.dzdy += s.b[i] * scale * p[i].z();
    s.z0 += s.c[i] * scale * p[i].z();
  }
  const auto [z_min, z_max] = std::minmax({p[0].z(), p[1].z(), p[2].z()});
  s.z_min = static_cast<float>(z_min);
  s.z_max = static_cast<float>(z_max);
  return true;
}

// Columns whose centres lie inside of the triangle at the height y.
std::pair<int, int> Span(const Setup& s, double y, int width) {
  double low = 0;
  double high = width;
  for (int i = 0; i < 3; ++i) {
    const double rest = s.b[i] * y + s.c[i];
    if (s.a[i] > 0) {
      low = std::max(low, -rest / s.a[i]);
    } else if (s.a[i] < 0) {
      high = std::min(high, -rest / s.a[i]);
    } else if (rest < 0) {
      return {0, -1};
    }
  }
  return SampleRange(low, high, width);
}

// Returns the number of rows and samples visited.
int64_t Draw(const Setup& s, uint32_t id, DepthBuffer& buffer) {
  int64_t work = 0;
  for (int row = s.first_row; row <= s.last_row; ++row) {
    const double y = row + 0.5;
    const auto [first, last] = Span(s, y, buffer.width);
    for (int column = first; column <= last; ++column) {
      const double z = s.z0 + s.dzdx * (column + 0.5) + s.dzdy * y;
      // Slivers have steep planes: their depth stays between their corners'.
      const float depth = std::clamp(static_cast<float>(z), s.z_min, s.z_max);
      const size_t at = buffer.At(column, row);
      if (depth > buffer.depth[at]) {
        buffer.depth[at] = depth;
        buffer.triangle[at] = id;
      }
    }
    work += 1 + std::max(last - first + 1, 0);
  }
  return work;
}

std::array<Vector3d, 3> Corners(const std::vector<Vector3f>& points,
                                const Triangle& triangle) {
  return {points[triangle[0]].cast<double>(),
          points[triangle[1]].cast<double>(),
          points[triangle[2]].cast<double>()};
}

// An upper bound of what Draw() would return, summed.
double EstimateWork(const std::vector<Vector3f>& points,
                    const std::vector<Triangle>& triangles) {
  double work = 0;
  for (const Triangle& triangle : triangles) {
    const auto p = Corners(points, triangle);
    const auto [low, high] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
    work += (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2 + 2 * (high - low) + 1;
  }
  return work;
}

std::vector<uint32_t> NearestFirst(const std::vector<Vector3f>& points,
                                   const std::vector<Triangle>& triangles) {
  std::vector<float> depth;
  depth.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    depth.push_back(
        std::max({points[t[0]].z(), points[t[1]].z(), points[t[2]].z()}));
  }
  std::vector<uint32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(
      order.begin(), order.end(),
      [&depth](uint32_t i, uint32_t j) { return depth[i] > depth[j]; });
  return order;
}

}  // namespace

DepthBuffer::DepthBuffer(int width, int height)
    : width(width),
      height(height),
      triangle(size_t(width) * height, kNoTriangle),
      depth(size_t(width) * height, -std::numeric_limits<float>::infinity()) {}

void Rasterize(const std::vector<Vector3f>& points,
               const std::vector<Triangle>& triangles, DepthBuffer& buffer) {
  const int64_t most = 100 * int64_t{buffer.width} * buffer.height;
  std::vector<uint32_t> order;
  if (EstimateWork(points, triangles) > static_cast<double>(most)) {
    order = NearestFirst(points, triangles);
  }
  int64_t work = 0;
  for (size_t i = 0; i < triangles.size() && work <= most; ++i) {
    const auto t = order.empty() ? static_cast<uint32_t>(i) : order[i];
    Setup setup;
    if (!SetUp(Corners(points, triangles[t]), buffer.height, setup)) continue;
    work += Draw(setup, t, buffer);
  }
}

}  // namespace marrow
