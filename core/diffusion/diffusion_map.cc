#include "core/diffusion/diffusion_map.h"

#include <algorithm>
#include <cmath>

namespace marrow {
namespace {

// Eigenvalues closer than this share of their size are one cluster: symmetric
// shapes have them equal but for rounding, and half a cluster would depend on
// that rounding.
constexpr double kClusterGap = 1e-5;

bool SameCluster(double lower, double upper) {
  return upper - lower <= kClusterGap * upper;
}

}  // namespace

double TimeScale(double slowest, double area_share) {
  return area_share / (2 * slowest);
}

std::optional<uint32_t> MapDimension(const EigenPairs& pairs, double t,
                                     double delta) {
  const uint32_t available = pairs.NumPairs() - 1;
  const auto& lambda = pairs.eigenvalues;
  uint32_t dimension = 0;
  while (dimension < available && std::exp(-lambda[dimension + 1] * t) > delta)
    ++dimension;
  dimension = std::max(dimension, 1u);
  while (dimension < available &&
         SameCluster(lambda[dimension], lambda[dimension + 1]))
    ++dimension;
  if (dimension == available && !pairs.complete) return std::nullopt;
  return dimension;
}

uint32_t NumPairsOfWholeClusters(const EigenPairs& pairs, uint32_t most) {
  const uint32_t available = std::max(pairs.NumPairs(), 1u) - 1;
  const uint32_t all = std::min(available, most);
  const auto& lambda = pairs.eigenvalues;
  uint32_t whole = all;
  if (all < available) {
    while (whole > 0 && SameCluster(lambda[whole], lambda[whole + 1])) --whole;
    return whole;
  }
  while (whole > 1 && SameCluster(lambda[whole - 1], lambda[whole])) --whole;
  return whole == all || pairs.complete ? all : whole - 1;
}

DiffusionMap BuildDiffusionMap(const EigenPairs& pairs,
                               std::span<const uint32_t> vertices, double t,
                               uint32_t dimension) {
  const Eigen::RowVectorXd weight =
      (-t * pairs.eigenvalues.segment(1, dimension)).array().exp();
  DiffusionMap Phi(vertices.size(), dimension);
  for (size_t i = 0; i < vertices.size(); ++i)
    Phi.row(i) = pairs.eigenvectors.row(vertices[i])
                     .segment(1, dimension)
                     .cast<double>()
                     .cwiseProduct(weight);
  return Phi;
}

AverageDistance::AverageDistance(const DiffusionMap& Phi, const FaceSet& set)
    : Phi_(Phi), mean_(Eigen::RowVectorXd::Zero(Phi.cols())), Q_(0) {
  double area = 0;
  for (uint32_t f : set.members) {
    double products = 0;
    for (int i = 0; i < 3; ++i) {
      const auto row = Phi.row(set.triangles[f][i]);
      mean_ += set.areas[f] / 3 * row;
      products +=
          row.squaredNorm() + row.dot(Phi.row(set.triangles[f][(i + 1) % 3]));
    }
    Q_ += set.areas[f] * products;
    area += set.areas[f];
  }
  mean_ /= area;
  Q_ /= 6 * area;
}

double AverageDistance::At(uint32_t v) const {
  const auto row = Phi_.row(v);
  return row.squaredNorm() - 2 * row.dot(mean_) + Q_;
}

double AverageDistance::Mean() const { return 2 * (Q_ - mean_.squaredNorm()); }

double MeanDistance(const DiffusionMap& Phi, const FaceSet& set,
                    std::span<const double> distance) {
  double sum = 0, area = 0;
  Eigen::RowVectorXd a(Phi.cols()), b(Phi.cols());
  for (uint32_t f : set.members) {
    const Triangle& corner = set.triangles[f];
    a = Phi.row(corner[2]) - Phi.row(corner[0]);
    b = Phi.row(corner[2]) - Phi.row(corner[1]);
    double mean = 0;
    for (uint32_t v : corner) mean += distance[v] / 3;
    mean += (a.dot(b) - a.squaredNorm() - b.squaredNorm()) / 6;
    sum += set.areas[f] * mean;
    area += set.areas[f];
  }
  return sum / area;
}

}  // namespace marrow
