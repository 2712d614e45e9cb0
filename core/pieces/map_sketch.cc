// A map of a region has as many dimensions as waves of its scale fit on the
// whole mesh; on the region itself they look alike, and some ten directions
// hold all but all of the differences. Any orthonormal directions give valid
// bounds, so those that a sample shows are good enough.
#include "core/pieces/map_sketch.h"

#include <algorithm>

namespace marrow {
namespace {

constexpr Eigen::Index kSample = 512;
constexpr double kRounding = 1e-13;

using Directions =
    Eigen::Matrix<double, Eigen::Dynamic, MapSketch::kDimensions>;

// Rows spread over the map, less their mean.
Eigen::MatrixXd SampleOf(const DiffusionMap& Phi) {
  const Eigen::Index count = std::min(kSample, Phi.rows());
  Eigen::MatrixXd sample(count, Phi.cols());
  for (Eigen::Index i = 0; i < count; ++i)
    sample.row(i) = Phi.row(i * Phi.rows() / count);
  sample.rowwise() -= sample.colwise().mean().eval();
  return sample;
}

// Gram-Schmidt, the longest rest first. Zero where nothing is left.
Directions MainDirections(Eigen::MatrixXd sample) {
  Directions Q = Directions::Zero(sample.cols(), MapSketch::kDimensions);
  const double whole = sample.squaredNorm();
  for (int k = 0; k < Q.cols(); ++k) {
    Eigen::Index longest;
    const double rest = sample.rowwise().squaredNorm().maxCoeff(&longest);
    if (!(rest > kRounding * whole)) break;
    Eigen::VectorXd q = sample.row(longest).transpose();
    // Twice, for the rests have lost digits.
    for (int i = 0; i < 2; ++i) {
      q -= Q.leftCols(k) * (Q.leftCols(k).transpose() * q).eval();
      q.normalize();
    }
    Q.col(k) = q;
    sample -= (sample * q).eval() * q.transpose();
  }
  return Q;
}

}  // namespace

MapSketch::MapSketch(const DiffusionMap& Phi)
    : Phi_(&Phi), rows_(Phi.rows(), kDimensions) {
  if (Phi.cols() <= kDimensions) {
    rows_.leftCols(Phi.cols()) = Phi;
    rows_.rightCols(kDimensions - Phi.cols()).setZero();
  } else {
    rows_.noalias() = Phi * MainDirections(SampleOf(Phi));
  }
  slack_ = kRounding * Phi.rowwise().squaredNorm().maxCoeff();
}

}  // namespace marrow
