#include "core/boundaries/curvature.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/status_macros.h"
#include "core/boundaries/multigrid.h"
#include "core/mesh/angle.h"
#include "core/mesh/rims.h"
#include "core/operators/laplacian.h"

namespace marrow {
namespace {

constexpr double kTolerance = 1e-6;  // of a step's residual

// Around a hole, at most; of a mesh of area 1. It is that of a finger.
constexpr double kSmallHole = 0.2;

// From one width to the next, the total of |K| falls by a factor of at most 2
// on smooth bodies with limbs, and of 2.5 to 6 where noise is what is seen.
// Beyond the first widths it falls on any body as its features go.
constexpr double kNoiseDecay = 2.4;
constexpr uint32_t kNoiseWidths = 5;

// In units of the largest extent, so that squares stay within a double.
Positions UnitExtentPositions(const TriangleMesh& mesh) {
  const Eigen::RowVector3d low = mesh.positions.colwise().minCoeff();
  const double extent = (mesh.positions.colwise().maxCoeff() - low).maxCoeff();
  return (mesh.positions.rowwise() - low) / extent;
}

}  // namespace

double AreaAt(const TriangleMesh& mesh, const Positions& positions) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    const Eigen::Vector3d u = (positions.row(b) - positions.row(a)).transpose();
    const Eigen::Vector3d v = (positions.row(c) - positions.row(a)).transpose();
    area += 0.5 * u.cross(v).norm();
  }
  return area;
}

Positions UnitAreaPositions(const TriangleMesh& mesh) {
  const Positions unit = UnitExtentPositions(mesh);
  return unit / std::sqrt(AreaAt(mesh, unit));
}

std::vector<double> AngleDefects(const TriangleMesh& mesh,
                                 const Adjacency& adjacency) {
  const Positions unit = UnitExtentPositions(mesh);
  std::vector<double> defects(mesh.NumVertices(), 2 * std::numbers::pi);
  const auto subtract = [&](uint32_t at, uint32_t before, uint32_t after) {
    defects[at] -= Angle((unit.row(before) - unit.row(at)).transpose(),
                         (unit.row(after) - unit.row(at)).transpose());
  };
  for (const Triangle& face : mesh.faces)
    for (int i = 0; i < 3; ++i)
      subtract(face[i], face[(i + 1) % 3], face[(i + 2) % 3]);
  const Holes holes =
      SmallHoles(adjacency, unit, kSmallHole * std::sqrt(AreaAt(mesh, unit)));
  for (const auto& [vertex, angle] : holes.corners) defects[vertex] -= angle;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    if (adjacency.EdgeFaces(e).size() != 2 && !holes.has_edge[e])
      for (uint32_t v : adjacency.EdgeVertices(e)) defects[v] = 0;
  return defects;
}

absl::StatusOr<Curvature> Curvature::Measure(const TriangleMesh& mesh,
                                             const Adjacency& adjacency,
                                             const CancelToken& cancel) {
  const std::vector<double> defects = AngleDefects(mesh, adjacency);
  const Eigen::Map<const Eigen::VectorXd> K(defects.data(), defects.size());
  MARROW_ASSIGN_OR_RETURN(const Laplacian laplacian,
                          BuildLaplacian(mesh, cancel));
  Multigrid grid(laplacian);
  Curvature result;
  result.values_.resize(defects.size() * kNumWidths);
  Eigen::VectorXd k = K.cwiseQuotient(laplacian.M);
  std::array<double, kNumWidths> total_absolute;
  double spread = 0;
  for (uint32_t i = 0; i < kNumWidths; ++i) {
    const double width = std::ldexp(kLeastWidth, static_cast<int>(i));
    grid.SetStep(width * width - spread);
    spread = width * width;
    grid.Solve(laplacian.M.cwiseProduct(k), kTolerance, cancel, k);
    MARROW_RETURN_IF_ERROR(cancel.Check());
    total_absolute[i] = laplacian.M.dot(k.cwiseAbs());
    for (Eigen::Index v = 0; v < k.size(); ++v)
      result.values_[v * kNumWidths + i] = k[v];
  }
  result.DropNoise(total_absolute);
  return result;
}

void Curvature::DropNoise(const std::array<double, kNumWidths>& total) {
  uint32_t first = 0;  // width that is not noise
  for (uint32_t i = 0; i < kNoiseWidths; ++i)
    if (total[i] > kNoiseDecay * total[i + 1]) first = i + 1;
  for (size_t v = 0; v < values_.size(); v += kNumWidths)
    std::fill_n(&values_[v], first, values_[v + first]);
}

double Curvature::At(uint32_t vertex, double width) const {
  const double place = std::clamp(std::log2(width / kLeastWidth), 0.0,
                                  static_cast<double>(kNumWidths - 1));
  const auto i = std::min(static_cast<uint32_t>(place), kNumWidths - 2);
  const double* values = &values_[uint64_t{vertex} * kNumWidths + i];
  return values[0] + (place - i) * (values[1] - values[0]);
}

}  // namespace marrow
