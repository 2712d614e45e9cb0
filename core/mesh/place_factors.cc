#include "core/mesh/place_factors.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/mesh/unit_box.h"

namespace marrow {
namespace {

// Of the waves around each point, in usual edges. Shorter ones would pass
// rounding on to the factors, longer ones give neighbours nearly equal factors.
constexpr std::array<double, 3> kWaves = {3.1, 3.7, 4.3};
// A direction shorter than that, for a mesh of area 1, is that of rounding.
constexpr double kLeastDirection = 1e-3;

struct Frame {
  double area = 0;
  // Points that move with the mesh.
  std::array<Eigen::Vector3d, 3> points;
};

struct FaceSum {
  double area;
  Eigen::Vector3d centre;
};

FaceSum Measure(const Positions& unit, const Triangle& face) {
  const Eigen::Vector3d a = unit.row(face[0]).transpose();
  const Eigen::Vector3d b = unit.row(face[1]).transpose();
  const Eigen::Vector3d c = unit.row(face[2]).transpose();
  return {0.5 * (b - a).cross(c - a).norm(), (a + b + c) / 3};
}

// Of length 1, unless it is short.
Eigen::Vector3d Direction(const Eigen::Vector3d& v) {
  return v / std::hypot(v.norm(), kLeastDirection);
}

// The centroid, and two points off it: where the mesh reaches farther out, and
// that again by its second moments.
Frame FrameOf(const std::vector<Triangle>& faces, const Positions& unit) {
  Frame frame;
  const Eigen::Vector3d origin = unit.colwise().mean().transpose();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Triangle& face : faces) {
    const FaceSum of = Measure(unit, face);
    frame.area += of.area;
    sum += of.area * (of.centre - origin);
  }
  if (!(frame.area > 0)) return frame;
  const Eigen::Vector3d centroid = origin + sum / frame.area;
  const double size = std::sqrt(frame.area);
  Eigen::Vector3d reach = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Triangle& face : faces) {
    const FaceSum of = Measure(unit, face);
    const Eigen::Vector3d at = (of.centre - centroid) / size;
    const double share = of.area / frame.area;
    reach += share * at.squaredNorm() * at;
    moments += share * at * at.transpose();
  }
  frame.points = {centroid, centroid + size * Direction(reach),
                  centroid + size * Direction(moments * reach)};
  return frame;
}

// From -1 to 1 and back, all between as often.
double Wave(double periods) {
  return 4 * std::abs(periods - std::floor(periods) - 0.5) - 1;
}

}  // namespace

std::vector<double> PlaceFactors(const TriangleMesh& mesh, double spread) {
  std::vector<double> factors(mesh.NumVertices(), 1);
  const Positions unit = mesh.positions * UnitScale(mesh);
  const Frame frame = FrameOf(mesh.faces, unit);
  if (!(frame.area > 0)) return factors;
  // Of an equilateral triangle.
  const double edge =
      std::sqrt(4 / std::sqrt(3.0) * frame.area / mesh.NumFaces());
  for (uint32_t v = 0; v < factors.size(); ++v) {
    double wave = 0;
    for (size_t i = 0; i < kWaves.size(); ++i)
      wave += Wave((unit.row(v).transpose() - frame.points[i]).norm() /
                   (kWaves[i] * edge));
    factors[v] = std::pow(1 + spread, wave / kWaves.size());
  }
  return factors;
}

}  // namespace marrow
