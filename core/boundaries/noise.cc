#include "core/boundaries/noise.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/boundaries/curvature.h"
#include "core/mesh/orientation.h"

namespace marrow {
namespace {

// Between the least agreement of shapes, .28 where fans were divided, and the
// greatest of noise, .16 on 800 vertices.
constexpr double kNoisyAgreement = 0.22;
// In edges: lower bumps are none. What is left of a flat sheet that was turned
// is rounding, and no two roundings agree.
constexpr double kLeastBump = 1e-3;

// Forward to the mean of the neighbours, and a little more back, so that waves
// much longer than an edge neither shrink nor grow.
constexpr double kForward = 0.5;
constexpr double kBack = 0.53;
constexpr int kCalmSteps = 20;
// What is kept has at least this share of the area that it had.
constexpr double kLeastArea = 0.01;

// For each vertex the mean of `values`, a row a vertex, over its neighbours.
template <typename Values>
Values NeighbourMeans(const Adjacency& adjacency, const Values& values) {
  Values sums = Values::Zero(values.rows(), values.cols());
  Eigen::VectorXd count = Eigen::VectorXd::Zero(values.rows());
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const auto [a, b] = adjacency.EdgeVertices(e);
    sums.row(a) += values.row(b);
    sums.row(b) += values.row(a);
    ++count[a];
    ++count[b];
  }
  return sums.array().colwise() / count.array().max(1);
}

double MeanSquareEdge(const Adjacency& adjacency, const Positions& unit) {
  double sum = 0;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const auto [a, b] = adjacency.EdgeVertices(e);
    sum += (unit.row(a) - unit.row(b)).squaredNorm();
  }
  return sum / adjacency.NumEdges();
}

// Shells that were sewn may look opposite ways; their faces would cancel out.
Positions VertexNormals(const TriangleMesh& mesh, const Adjacency& adjacency,
                        const Positions& unit) {
  const Sides sides = FindSides(mesh, adjacency);
  Positions normals = Positions::Zero(unit.rows(), 3);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const Triangle& face = mesh.faces[f];
    const Eigen::Vector3d u =
        (unit.row(face[1]) - unit.row(face[0])).transpose();
    const Eigen::Vector3d v =
        (unit.row(face[2]) - unit.row(face[0])).transpose();
    const Eigen::RowVector3d normal = u.cross(v).transpose();
    for (uint32_t corner : face)
      normals.row(corner) += sides.is_turned[f] ? -normal : normal;
  }
  return normals.rowwise().normalized();
}

}  // namespace

double BumpAgreement(const TriangleMesh& mesh, const Adjacency& adjacency) {
  const Positions unit = UnitAreaPositions(mesh);
  const Positions bumps = NeighbourMeans(adjacency, unit) - unit;
  const Eigen::VectorXd heights =
      bumps.cwiseProduct(VertexNormals(mesh, adjacency, unit)).rowwise().sum();
  const double square = heights.squaredNorm();
  const double least = std::pow(kLeastBump, 2) *
                       MeanSquareEdge(adjacency, unit) *
                       static_cast<double>(heights.size());
  return square > least
             ? heights.dot(NeighbourMeans(adjacency, heights)) / square
             : 1;
}

TriangleMesh WithoutNoise(const TriangleMesh& mesh,
                          const Adjacency& adjacency) {
  if (BumpAgreement(mesh, adjacency) >= kNoisyAgreement) return mesh;
  TriangleMesh calm = mesh;
  for (int step = 0; step < kCalmSteps; ++step)
    for (double weight : {kForward, -kBack})
      calm.positions +=
          weight * (NeighbourMeans(adjacency, calm.positions) - calm.positions);
  return AreaAt(mesh, calm.positions) >
                 kLeastArea * AreaAt(mesh, mesh.positions)
             ? calm
             : mesh;
}

}  // namespace marrow
