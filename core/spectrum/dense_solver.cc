// Householder's tridiagonal form and implicit QR, step by step as in Eigen's
// SelfAdjointEigenSolver and with its bytes: that cannot be cancelled, and
// takes seconds for two thousand rows.
#include "core/spectrum/dense_solver.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error_reason.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

using Eigen::Index;

// Steps a row, on average, from which on nothing more will come.
constexpr Index kMostSteps = 30;

class DenseSolver {
 public:
  DenseSolver(const Eigen::SparseMatrix<double>& matrix,
              const CancelToken& cancel)
      : n_(matrix.rows()),
        cancel_(cancel),
        Q_(Eigen::MatrixXd(matrix).triangularView<Eigen::Lower>()) {}

  absl::StatusOr<MatrixPairs> Solve(int pairs) {
    if (n_ == 1) return MatrixPairs{Q_.col(0), Eigen::MatrixXd::Identity(1, 1)};
    const double largest = Q_.cwiseAbs().maxCoeff();
    const double scale = largest > 0 ? largest : 1;
    Q_ /= scale;
    MARROW_RETURN_IF_ERROR(Tridiagonalise());
    MARROW_RETURN_IF_ERROR(ExpandReflections());
    MARROW_RETURN_IF_ERROR(Diagonalise());
    Sort();
    diagonal_ *= scale;
    return MatrixPairs{diagonal_.head(pairs), Q_.leftCols(pairs)};
  }

 private:
  // Leaves the reflections that make the matrix tridiagonal below its
  // subdiagonal.
  absl::Status Tridiagonalise() {
    coefficients_.resize(n_ - 1);
    for (Index i = 0; i < n_ - 1; ++i) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      const Index rest = n_ - i - 1;
      double beta, h;
      auto v = Q_.col(i).tail(rest);
      v.makeHouseholderInPlace(h, beta);
      v[0] = 1;
      auto corner =
          Q_.bottomRightCorner(rest, rest).selfadjointView<Eigen::Lower>();
      auto w = coefficients_.tail(rest);
      w.noalias() = corner * (h * v);
      w += (h * -0.5 * w.dot(v)) * v;
      corner.rankUpdate(v, w, -1.0);
      v[0] = beta;
      coefficients_[i] = h;
    }
    diagonal_ = Q_.diagonal();
    subdiagonal_ = Q_.diagonal<-1>();
    return absl::OkStatus();
  }

  // Makes of the reflections their product.
  absl::Status ExpandReflections() {
    Eigen::VectorXd workspace(n_);
    Q_.diagonal().setOnes();
    Q_.triangularView<Eigen::StrictlyUpper>().setZero();
    for (Index k = n_ - 2; k >= 0; --k) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      const Index rest = n_ - k - 1;
      Q_.bottomRightCorner(rest, rest)
          .applyHouseholderOnTheLeft(Q_.col(k).tail(rest - 1), coefficients_[k],
                                     workspace.data());
      Q_.col(k).tail(rest).setZero();
    }
    return absl::OkStatus();
  }

  absl::Status Diagonalise() {
    Index steps = 0, begin = 0;
    for (Index end = n_ - 1; end > 0;) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      DropNegligible(begin, end);
      while (end > 0 && subdiagonal_[end - 1] == 0) --end;
      if (end <= 0) break;
      if (++steps > kMostSteps * n_)
        return WithReason(absl::InternalError("the dense solver gave up"),
                          kReasonSolverNotConverged);
      begin = end - 1;
      while (begin > 0 && subdiagonal_[begin - 1] != 0) --begin;
      Eigen::internal::tridiagonal_qr_step<Eigen::ColMajor>(
          diagonal_.data(), subdiagonal_.data(), begin, end, Q_.data(), n_);
    }
    return absl::OkStatus();
  }

  void DropNegligible(Index begin, Index end) {
    constexpr double kLeast = std::numeric_limits<double>::min();
    constexpr double kPrecision = 1 / std::numeric_limits<double>::epsilon();
    for (Index i = begin; i < end; ++i) {
      const double scaled = kPrecision * subdiagonal_[i];
      if (std::abs(subdiagonal_[i]) < kLeast ||
          scaled * scaled <=
              std::abs(diagonal_[i]) + std::abs(diagonal_[i + 1]))
        subdiagonal_[i] = 0;
    }
  }

  void Sort() {
    for (Index i = 0; i < n_ - 1; ++i) {
      Index least;
      diagonal_.tail(n_ - i).minCoeff(&least);
      if (least == 0) continue;
      std::swap(diagonal_[i], diagonal_[i + least]);
      Q_.col(i).swap(Q_.col(i + least));
    }
  }

  const Index n_;
  const CancelToken& cancel_;
  // The lower triangle of the matrix, then reflections, then their product,
  // then eigenvectors.
  Eigen::MatrixXd Q_;
  Eigen::VectorXd coefficients_;
  Eigen::VectorXd diagonal_;
  Eigen::VectorXd subdiagonal_;
};

}  // namespace

absl::StatusOr<MatrixPairs> SolveDensely(
    const Eigen::SparseMatrix<double>& matrix, int pairs,
    const CancelToken& cancel) {
  return DenseSolver(matrix, cancel).Solve(pairs);
}

}  // namespace marrow
