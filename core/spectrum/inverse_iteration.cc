// With Y = (A - s I)^-1 X, the projection of A - s I on Y is Y'(A - s I)Y =
// Y'X: it takes no product with A. Columns of Y are scaled to length 1 before,
// for near an eigenvalue they are longer by orders.
#include "core/spectrum/inverse_iteration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

#include "core/base/error_reason.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

// Rows worked on at once: what there is of them stays in the cache.
constexpr int kChunk = 256;
// Columns that are near different eigenvectors are almost orthogonal; the least
// eigenvalue of their Gram matrix is near 1, and near 0 where two are one.
constexpr double kIndependent = 1e-3;

absl::Status SolveAll(const SupernodalFactor& factor, const RowMajorMatrix& X,
                      RowMajorMatrix& Y, const CancelToken& cancel) {
  AlignedBuffer buffer(static_cast<size_t>(X.rows()) * kBlock);
  Team alone(1);
  Eigen::Map<RowMajorMatrix> block(buffer.data(), X.rows(), kBlock);
  for (Eigen::Index begin = 0; begin < X.cols(); begin += kBlock) {
    block = X.middleCols(begin, kBlock);
    MARROW_RETURN_IF_ERROR(factor.Solve(block.data(), alone, cancel));
    Y.middleCols(begin, kBlock) = block;
  }
  return absl::OkStatus();
}

// U'V.
absl::StatusOr<Eigen::MatrixXd> Project(const RowMajorMatrix& U,
                                        const RowMajorMatrix& V,
                                        const CancelToken& cancel) {
  const int width = static_cast<int>(U.cols());
  RowMajorMatrix product = RowMajorMatrix::Zero(width, width);
  for (Eigen::Index begin = 0; begin < U.rows(); begin += kChunk) {
    const int rows =
        static_cast<int>(std::min<Eigen::Index>(kChunk, U.rows() - begin));
    MARROW_RETURN_IF_ERROR(cancel.Check());
    Kernels().multiply_add(
        width, width, rows, {U.data() + begin * width, 1, width},
        V.data() + begin * width, width, product.data(), width);
  }
  return product;
}

// X = Y B.
absl::Status Combine(const RowMajorMatrix& Y, const RowMajorMatrix& B,
                     RowMajorMatrix& X, const CancelToken& cancel) {
  const int width = static_cast<int>(Y.cols());
  X.setZero();
  for (Eigen::Index begin = 0; begin < Y.rows(); begin += kChunk) {
    const int rows =
        static_cast<int>(std::min<Eigen::Index>(kChunk, Y.rows() - begin));
    MARROW_RETURN_IF_ERROR(cancel.Check());
    Kernels().multiply_add(rows, width, width,
                           {Y.data() + begin * width, width, 1}, B.data(),
                           width, X.data() + begin * width, width);
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status IterateInversely(const SupernodalFactor& factor, Window& window,
                              const CancelToken& cancel) {
  RowMajorMatrix& X = window.vectors;
  const Eigen::Index count = window.values.size();
  RowMajorMatrix Y(X.rows(), X.cols());
  MARROW_RETURN_IF_ERROR(SolveAll(factor, X, Y, cancel));
  MARROW_ASSIGN_OR_RETURN(Eigen::MatrixXd gram, Project(Y, Y, cancel));
  gram.conservativeResize(count, count);
  MARROW_ASSIGN_OR_RETURN(Eigen::MatrixXd product, Project(Y, X, cancel));
  product.conservativeResize(count, count);

  const Eigen::VectorXd scale = gram.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd H = scale.asDiagonal() *
                            (0.5 * (product + product.transpose())) *
                            scale.asDiagonal();
  const Eigen::MatrixXd G = scale.asDiagonal() * gram * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spread(
      G, Eigen::EigenvaluesOnly);
  if (!(spread.eigenvalues()[0] > kIndependent)) {
    return WithReason(absl::InternalError("an eigenvector was found twice"),
                      kReasonSolverNotConverged);
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(H, G);
  window.values = ritz.eigenvalues().array() + factor.shift();
  RowMajorMatrix B = RowMajorMatrix::Zero(X.cols(), X.cols());
  B.topLeftCorner(count, count) = scale.asDiagonal() * ritz.eigenvectors();
  return Combine(Y, B, X, cancel);
}

}  // namespace marrow
