#include "core/operators/laplacian.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/operators/bridges.h"

namespace marrow {
namespace {

// Entry i of a face is the length of the edge from corner i to i + 1.
using EdgeLengths = std::vector<std::array<double, 3>>;

// Lengths in units of the largest extent, so that squares of coordinates near
// 1e20 or 1e-20 neither overflow nor vanish.
EdgeLengths MeasureEdges(const TriangleMesh& mesh) {
  const Eigen::RowVector3d low = mesh.positions.colwise().minCoeff();
  const double extent = (mesh.positions.colwise().maxCoeff() - low).maxCoeff();
  auto unit = [&](uint32_t v) -> Eigen::RowVector3d {
    return (mesh.positions.row(v) - low) / extent;
  };
  EdgeLengths lengths(mesh.NumFaces());
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const Triangle& face = mesh.faces[f];
    for (int i = 0; i < 3; ++i)
      lengths[f][i] = (unit(face[i]) - unit(face[(i + 1) % 3])).norm();
  }
  return lengths;
}

double MeanLength(const EdgeLengths& lengths) {
  double sum = 0;
  for (const auto& l : lengths) sum += l[0] + l[1] + l[2];
  return sum / (3.0 * lengths.size());
}

// Adds the least constant to all edges that leaves every triangle inequality
// strict by a millionth of the mean edge; returns it in units of the mean edge.
double Mollify(EdgeLengths& lengths) {
  const double mean = MeanLength(lengths);
  const double slack = 1e-6 * mean;
  double added = 0;
  for (const auto& l : lengths) {
    const double longest = std::max({l[0], l[1], l[2]});
    added = std::max(added, slack + 2 * longest - (l[0] + l[1] + l[2]));
  }
  if (added == 0) return 0;
  for (auto& l : lengths)
    for (double& length : l) length += added;
  return added / mean;
}

// Heron's formula in Kahan's order, which is stable for needles.
double TriangleArea(std::array<double, 3> l) {
  std::sort(l.begin(), l.end());
  const auto [c, b, a] = l;
  const double product =
      (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return 0.25 * std::sqrt(std::max(0.0, product));
}

void AddWeight(uint32_t i, uint32_t j, double weight,
               std::vector<Eigen::Triplet<double>>& triplets) {
  triplets.emplace_back(i, j, -weight);
  triplets.emplace_back(j, i, -weight);
  triplets.emplace_back(i, i, weight);
  triplets.emplace_back(j, j, weight);
}

}  // namespace

Laplacian BuildLaplacian(const TriangleMesh& mesh) {
  EdgeLengths lengths = MeasureEdges(mesh);
  Laplacian result;
  result.mollification = Mollify(lengths);
  result.M = Eigen::VectorXd::Zero(mesh.NumVertices());
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(12 * lengths.size());
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const double area = TriangleArea(lengths[f]);
    const auto& l = lengths[f];
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      // The angle opposite to edge i, between edges j and k.
      const double cotangent =
          (l[j] * l[j] + l[k] * l[k] - l[i] * l[i]) / (4 * area);
      AddWeight(mesh.faces[f][i], mesh.faces[f][j], 0.5 * cotangent, triplets);
      result.M[mesh.faces[f][i]] += area / 3;
    }
  }
  // A bridge conducts as two equilateral triangles across one edge do, about 1.
  for (const auto& [u, v] : FindBridges(mesh)) AddWeight(u, v, 1.0, triplets);
  result.L.resize(mesh.NumVertices(), mesh.NumVertices());
  result.L.setFromTriplets(triplets.begin(), triplets.end());
  result.M /= result.M.sum();
  return result;
}

std::vector<double> FaceAreaShares(const TriangleMesh& mesh) {
  const EdgeLengths lengths = MeasureEdges(mesh);
  std::vector<double> areas(mesh.NumFaces());
  double sum = 0;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    sum += areas[f] = TriangleArea(lengths[f]);
  for (double& area : areas) area /= sum;
  return areas;
}

}  // namespace marrow
