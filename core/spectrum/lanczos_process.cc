// A block is made orthogonal to the last two, which in exact arithmetic is all
// it takes. How far rounding has made it overlap with the others is estimated,
// and taken away where it would be too much (Simon 1984): every third step or
// so, which halves the traffic with the basis.
//
// The process begins with the solutions of a random block, not with that block:
// it would hold little of what is wanted. The projected matrix T is kept whole,
// not its band alone, so that a block may hold new directions where the process
// found an invariant subspace; that is how a cluster with more members than a
// block has columns comes out whole.
#include "core/spectrum/lanczos_process.h"

#include <utility>

#include "core/base/status_macros.h"

namespace marrow {
namespace {

// Vectors of the basis may overlap by so much: T is as good then as if they did
// not at all, while this is below the root of the rounding unit (Simon 1984).
constexpr double kMostOverlap = 1e-8;
// More than this is not taken away without making the block orthonormal anew.
constexpr double kLargeOverlap = 1e-6;

}  // namespace

absl::Status LanczosProcess::FillAnew(double* Z) {
  basis_.FillRandomly(Z, ++seed_);
  return factor_.Solve(Z, team_, cancel_);
}

absl::Status LanczosProcess::Append(LanczosBasis::Growth& growth) {
  Eigen::MatrixXd overlap;
  const auto is_large = [&](const LanczosBasis::Growth& found) {
    overlap = overlaps_.Next(T_, found);
    return !(overlap.cwiseAbs().maxCoeff() < kLargeOverlap);
  };
  MARROW_RETURN_IF_ERROR(basis_.Append(
      [this](double* Z) { return FillAnew(Z); }, is_large, cancel_, growth));
  overlaps_.NoteRounding(growth);
  const Eigen::Index rows = basis_.dimension() - kBlock;
  if (growth.is_to_all) {
    overlaps_.AppendOrthogonal(rows);
    return absl::OkStatus();
  }
  if (overlap.cwiseAbs().maxCoeff() < kMostOverlap) {
    overlaps_.Append(std::move(overlap));
    return absl::OkStatus();
  }
  // The block before has its share in the overlaps of those that follow.
  overlaps_.AppendOrthogonal(rows - kBlock);
  overlaps_.AppendOrthogonal(rows);
  return basis_.SeparateLastTwo(cancel_);
}

absl::Status LanczosProcess::Start() {
  MARROW_RETURN_IF_ERROR(FillAnew(basis_.Block(0)));
  LanczosBasis::Growth unused;
  return Append(unused);
}

absl::Status LanczosProcess::Step() {
  double* W = basis_.Block(basis_.num_blocks());
  basis_.Copy(basis_.num_blocks() - 1, W);
  MARROW_RETURN_IF_ERROR(factor_.Solve(W, team_, cancel_));
  LanczosBasis::Growth growth;
  MARROW_RETURN_IF_ERROR(Append(growth));
  const Eigen::Index old = T_.rows();
  T_.conservativeResize(old + kBlock, old + kBlock);
  T_.rightCols(kBlock) = growth.projection;
  T_.bottomRows(kBlock) = growth.projection.transpose();
  R_ = growth.remainder;
  return absl::OkStatus();
}

}  // namespace marrow
