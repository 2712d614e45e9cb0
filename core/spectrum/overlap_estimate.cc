#include "core/spectrum/overlap_estimate.h"

#include <Eigen/LU>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace marrow {
namespace {

using Eigen::Index;

// What rounding leaves of an overlap that was removed; and what a step adds at
// least, in units of the largest entry of T, and in units of what shows.
constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();
constexpr double kStepRounding = 8 * std::numeric_limits<double>::epsilon();
constexpr double kShownRounding = 4;

// Of the same size everywhere, the signs without a pattern, or it would cancel.
Eigen::MatrixXd Rounding(Index rows, double size) {
  Eigen::MatrixXd result(rows, kBlock);
  uint32_t state = 1;
  for (double& entry : result.reshaped()) {
    state = state * 1664525u + 1013904223u;
    entry = state >> 31 ? size : -size;
  }
  return result;
}

double Asymmetry(const LanczosBasis::Growth& growth) {
  if (growth.projection.rows() < kBlock) return 0;
  const Eigen::MatrixXd last = growth.projection.bottomRows(kBlock);
  return (last - last.transpose()).cwiseAbs().maxCoeff();
}

}  // namespace

Eigen::MatrixXd OverlapEstimate::Next(
    const Eigen::MatrixXd& T, const LanczosBasis::Growth& growth) const {
  // Of these blocks the next one was not made orthogonal to.
  const Index far = before_.rows();
  Eigen::MatrixXd overlap = Rounding(T.rows() + kBlock, kRounding);
  if (far == 0) return overlap;
  const RowMajorMatrix& P = growth.projection;
  Eigen::MatrixXd next = T.topRows(far) * last_;
  next -= before_ * P.middleRows(far, kBlock);
  next -= last_.topRows(far) * P.bottomRows(kBlock);
  next += Rounding(far, std::max({kStepRounding * T.cwiseAbs().maxCoeff(),
                                  kShownRounding * Asymmetry(growth),
                                  kShownRounding * rounding_}));
  const Eigen::MatrixXd R = growth.remainder;
  overlap.topRows(far) = next * R.inverse();
  return overlap;
}

void OverlapEstimate::NoteRounding(const LanczosBasis::Growth& growth) {
  rounding_ = std::max(rounding_, Asymmetry(growth));
}

void OverlapEstimate::Append(Eigen::MatrixXd overlap) {
  before_ = std::move(last_);
  last_ = std::move(overlap);
}

void OverlapEstimate::AppendOrthogonal(Index rows) {
  Append(Rounding(rows, kRounding));
}

}  // namespace marrow
