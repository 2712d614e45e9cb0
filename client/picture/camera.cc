#include "client/picture/camera.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>

namespace marrow {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Points spread evenly over a surface.
struct Samples {
  std::vector<Vector3f> points;
  std::vector<uint32_t> segments;  // numbered from 0
  std::vector<double> segment_sizes;
};

constexpr int kNumSamples = 30000;

double Area(const Surface& surface, size_t t) {
  const auto& [a, b, c] = surface.triangles[t];
  const Vector3f& p = surface.points[a];
  return (surface.points[b] - p).cross(surface.points[c] - p).norm() / 2.0;
}

// A point in the triangle by a low-discrepancy sequence.
Vector3f PointInside(const Surface& surface, size_t t, size_t index) {
  double u = std::fmod(0.5 + 0.7548776662466927 * index, 1.0);
  double v = std::fmod(0.5 + 0.5698402909980532 * index, 1.0);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const auto& [a, b, c] = surface.triangles[t];
  const Vector3f& p = surface.points[a];
  return p + static_cast<float>(u) * (surface.points[b] - p) +
         static_cast<float>(v) * (surface.points[c] - p);
}

Samples MakeSamples(const Surface& surface) {
  double total = 0;
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    total += Area(surface, t);
  }
  Samples samples;
  std::map<uint32_t, uint32_t> numbers;
  double area = 0;
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    area += Area(surface, t);
    const auto number = static_cast<uint32_t>(numbers.size());
    const uint32_t segment =
        numbers.try_emplace(surface.labels[t], number).first->second;
    while (total > 0 && samples.points.size() < kNumSamples &&
           (samples.points.size() + 0.5) * total < area * kNumSamples) {
      samples.points.push_back(PointInside(surface, t, samples.points.size()));
      samples.segments.push_back(segment);
    }
  }
  samples.segment_sizes.assign(numbers.size(), 0);
  for (uint32_t s : samples.segments) ++samples.segment_sizes[s];
  return samples;
}

Vector3f Mean(const Samples& samples) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3f& p : samples.points) sum += p.cast<double>();
  return (sum / std::max<size_t>(samples.points.size(), 1)).cast<float>();
}

// The least and greatest component of the samples along an axis.
std::pair<float, float> Extent(const Samples& samples, const Vector3f& axis) {
  std::pair<float, float> extent = {0, 0};
  for (const Vector3f& p : samples.points) {
    extent.first = std::min(extent.first, p.dot(axis));
    extent.second = std::max(extent.second, p.dot(axis));
  }
  return extent;
}

// Would it stand? The centre of mass has to lie above what touches the floor:
// in every horizontal direction, something there reaches as far out.
bool Stands(const Samples& samples, const Vector3f& up) {
  constexpr float kFloor = 0.05f;  // of the height
  constexpr float kSlack = 0.02f;  // of the longest side, which is 2
  const auto [bottom, top] = Extent(samples, up);
  const Vector3f mean = Mean(samples);
  const Vector3f e1 = up.unitOrthogonal();
  const Vector3f e2 = up.cross(e1);
  constexpr int kDirections = 16;
  std::array<float, kDirections> reach;
  reach.fill(-4);
  for (const Vector3f& p : samples.points) {
    if (p.dot(up) > bottom + kFloor * (top - bottom)) continue;
    for (int i = 0; i < kDirections; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * i / kDirections;
      const Vector3f out = std::cos(angle) * e1 + std::sin(angle) * e2;
      reach[i] = std::max(reach[i], (p - mean).dot(out));
    }
  }
  return *std::min_element(reach.begin(), reach.end()) > -2 * kSlack;
}

// Files have y up or z up. The axis on which the creature would stand is up;
// where it would on both (a person, who can also lie) or on neither, the one
// along which it is longer, or y where that does not tell.
Vector3d ChooseUp(const Samples& samples) {
  const bool stands_y = Stands(samples, Vector3f::UnitY());
  const bool stands_z = Stands(samples, Vector3f::UnitZ());
  if (stands_y && !stands_z) return Vector3d::UnitY();
  if (stands_z && !stands_y) return Vector3d::UnitZ();
  if (!stands_y) return Vector3d::UnitY();
  const auto [y_low, y_high] = Extent(samples, Vector3f::UnitY());
  const auto [z_low, z_high] = Extent(samples, Vector3f::UnitZ());
  const bool tall_z = z_high - z_low > 1.1f * (y_high - y_low);
  return tall_z ? Vector3d::UnitZ() : Vector3d::UnitY();
}

// The horizontal direction in which the samples spread least: what faces it is
// the broad side.
Vector3d BroadSide(const Samples& samples, const Vector3d& up) {
  const Vector3d mean = Mean(samples).cast<double>();
  const Vector3d e1 = up.unitOrthogonal();
  const Vector3d e2 = up.cross(e1);
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const Vector3f& p : samples.points) {
    const Vector3d d = p.cast<double>() - mean;
    const Eigen::Vector2d h(d.dot(e1), d.dot(e2));
    covariance += h * h.transpose();
  }
  const Eigen::Vector2d least =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance)
          .eigenvectors()
          .col(0);
  const Vector3d side = least.x() * e1 + least.y() * e2;
  // A person who models with y up looks along -z; with z up, along y.
  const Vector3d front(0.01, -0.1, 1);
  return side.dot(front) < 0 ? Vector3d(-side) : side;
}

View LookFrom(const Vector3d& toward, const Vector3d& up) {
  const Vector3d right = up.cross(toward).normalized();
  Matrix3d view;
  view << right.transpose(), toward.cross(right).transpose(),
      toward.transpose();
  return view.cast<float>();
}

struct Candidate {
  View view;
  double weight;
};

std::vector<Candidate> Candidates(const Vector3d& up, const Vector3d& side) {
  std::vector<Candidate> candidates;
  const Vector3d right = up.cross(side);
  constexpr double kDegree = std::numbers::pi / 180;
  for (const auto& [elevation, low_weight] :
       {std::pair(12.0, 1.0), std::pair(28.0, 0.97), std::pair(55.0, 0.9)}) {
    for (int azimuth = 30; azimuth < 390; azimuth += 30) {
      const double a = azimuth * kDegree;
      const double e = elevation * kDegree;
      const Vector3d flat = std::cos(a) * side + std::sin(a) * right;
      const double weight = azimuth % 90 == 0 ? 0.95 * low_weight : low_weight;
      candidates.push_back(
          {LookFrom(std::cos(e) * flat + std::sin(e) * up, up), weight});
    }
  }
  return candidates;
}

// The samples that no other sample hides, on a grid coarse enough to be
// covered without holes.
std::vector<bool> Visible(const Samples& samples, const View& view) {
  constexpr int kGrid = 72;
  constexpr float kReach = 1.74f;  // of the corner of a cube of side 2
  constexpr float kTolerance = 0.06f;
  std::vector<float> depth(size_t{kGrid} * kGrid,
                           -std::numeric_limits<float>::infinity());
  std::vector<int> cell;
  std::vector<float> sample_depth;
  for (const Vector3f& p : samples.points) {
    const Vector3f q = view * p;
    const auto grid = [](float x) {
      const float at = (x / kReach + 1) / 2 * kGrid;
      return std::clamp(static_cast<int>(at), 0, kGrid - 1);
    };
    cell.push_back(grid(q.y()) * kGrid + grid(q.x()));
    sample_depth.push_back(q.z());
    depth[cell.back()] = std::max(depth[cell.back()], q.z());
  }
  std::vector<bool> visible;
  for (size_t i = 0; i < cell.size(); ++i) {
    visible.push_back(sample_depth[i] > depth[cell[i]] - kTolerance);
  }
  return visible;
}

// How much is seen: square roots, so that a small segment that is hidden
// weighs more than the same area of a large one that is in sight anyway.
double Score(const Samples& samples, const std::vector<bool>& visible) {
  std::vector<double> seen(samples.segment_sizes.size(), 0);
  for (size_t i = 0; i < visible.size(); ++i) {
    if (visible[i]) ++seen[samples.segments[i]];
  }
  double score = 0;
  for (double s : seen) score += std::sqrt(s);
  return score;
}

std::vector<bool> Either(std::vector<bool> a, const std::vector<bool>& b) {
  for (size_t i = 0; i < a.size(); ++i) a[i] = a[i] || b[i];
  return a;
}

}  // namespace

std::vector<View> ChooseViews(const Surface& surface, int count) {
  const Samples samples = MakeSamples(surface);
  const Vector3d up = ChooseUp(samples);
  const std::vector<Candidate> candidates =
      Candidates(up, BroadSide(samples, up));
  std::vector<std::vector<bool>> visible;
  visible.reserve(candidates.size());
  for (const Candidate& candidate : candidates) {
    visible.push_back(Visible(samples, candidate.view));
  }
  std::vector<bool> shown(samples.points.size(), false);
  std::vector<View> views;
  while (static_cast<int>(views.size()) < count) {
    size_t best = 0;
    double best_score = -1;
    for (size_t c = 0; c < candidates.size(); ++c) {
      const double score =
          candidates[c].weight * Score(samples, Either(shown, visible[c]));
      if (score > best_score) {
        best_score = score;
        best = c;
      }
    }
    shown = Either(shown, visible[best]);
    views.push_back(candidates[best].view);
  }
  return views;
}

}  // namespace marrow
