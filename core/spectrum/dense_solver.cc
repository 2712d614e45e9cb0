// The symmetric QR algorithm (Golub and Van Loan, Matrix Computations, 8.3).
// Eigen's is quicker to write, but cannot be cancelled, and takes seconds for
// two thousand rows.
#include "core/spectrum/dense_solver.h"

#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/error_reason.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

using Eigen::Index;

// An eigenvalue takes two or three QR steps; so many a row never come.
constexpr Index kMostSteps = 40;

class DenseSolver {
 public:
  DenseSolver(Eigen::MatrixXd matrix, Index rows, const CancelToken& cancel)
      : n_(matrix.rows()),
        rows_(rows),
        cancel_(cancel),
        A_(std::move(matrix)) {}

  absl::StatusOr<MatrixPairs> Solve(Index pairs) {
    MARROW_RETURN_IF_ERROR(Tridiagonalise());
    MARROW_RETURN_IF_ERROR(rows_ == n_ ? MultiplyReflections()
                                       : ReflectLastRows());
    MARROW_RETURN_IF_ERROR(Diagonalise());
    return Lowest(pairs);
  }

 private:
  // A = Q T Q'. Leaves the unit vector v of each reflection I - 2 v v' in the
  // column that it cleared, below the diagonal; zeros where there was nothing
  // to clear.
  absl::Status Tridiagonalise() {
    off_.resize(std::max<Index>(n_ - 1, 0));
    for (Index k = 0; k + 1 < n_; ++k) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      const Index m = n_ - k - 1;
      auto v = A_.col(k).tail(m);
      off_[k] = v[0];
      if (v.tail(m - 1).isZero(0)) {
        v.setZero();
        continue;
      }
      off_[k] = v[0] > 0 ? -v.stableNorm() : v.stableNorm();
      v[0] -= off_[k];
      v /= v.stableNorm();
      auto rest = A_.bottomRightCorner(m, m).selfadjointView<Eigen::Lower>();
      Eigen::VectorXd w = rest * v;
      w -= v.dot(w) * v;
      rest.rankUpdate(v, w, -2.0);
    }
    diagonal_ = A_.diagonal();
    return absl::OkStatus();
  }

  // Q, from the last reflection to the first: each touches one row more.
  absl::Status MultiplyReflections() {
    Q_.setIdentity(n_, n_);
    for (Index k = n_ - 2; k >= 0; --k) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      const Index m = n_ - k - 1;
      const auto v = A_.col(k).tail(m);
      auto corner = Q_.bottomRightCorner(m, m);
      const Eigen::RowVectorXd along = v.transpose() * corner;
      corner.noalias() -= (2 * v) * along;
    }
    return absl::OkStatus();
  }

  // The last rows of Q, of which the first reflections are the first factors.
  absl::Status ReflectLastRows() {
    Q_.setZero(rows_, n_);
    Q_.rightCols(rows_).setIdentity();
    for (Index k = 0; k + 1 < n_; ++k) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      const Index m = n_ - k - 1;
      const auto v = A_.col(k).tail(m);
      const Eigen::VectorXd along = Q_.rightCols(m) * v;
      Q_.rightCols(m).noalias() -= (2 * along) * v.transpose();
    }
    return absl::OkStatus();
  }

  // QR steps on the last part of T that is not diagonal yet.
  absl::Status Diagonalise() {
    Index steps = 0;
    for (Index last = n_ - 1; last > 0;) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      if (IsNegligible(last - 1)) {
        off_[--last] = 0;
        continue;
      }
      Index first = last - 1;
      while (first > 0 && !IsNegligible(first - 1)) --first;
      if (++steps > kMostSteps * n_)
        return WithReason(absl::InternalError("the dense solver gave up"),
                          kReasonSolverNotConverged);
      Step(first, last);
    }
    return absl::OkStatus();
  }

  bool IsNegligible(Index k) const {
    return std::abs(off_[k]) <=
           std::numeric_limits<double>::min() +
               std::numeric_limits<double>::epsilon() *
                   (std::abs(diagonal_[k]) + std::abs(diagonal_[k + 1]));
  }

  // Of the two eigenvalues of T's last two rows, the one nearer to its last
  // entry (Wilkinson's shift).
  double Shift(Index last) const {
    const double half = (diagonal_[last - 1] - diagonal_[last]) / 2;
    const double off = off_[last - 1];
    const double root = std::hypot(half, off);
    return diagonal_[last] - off * (off / (half + std::copysign(root, half)));
  }

  // Chases the bulge from row `first` to row `last`.
  void Step(Index first, Index last) {
    double x = diagonal_[first] - Shift(last), bulge = off_[first];
    for (Index k = first; k < last; ++k) {
      const double r = std::hypot(x, bulge);
      const double c = r > 0 ? x / r : 1, s = r > 0 ? bulge / r : 0;
      if (k > first) off_[k - 1] = r;
      const double a = diagonal_[k], b = off_[k], d = diagonal_[k + 1];
      diagonal_[k] = c * (c * a + s * b) + s * (c * b + s * d);
      diagonal_[k + 1] = s * (s * a - c * b) + c * (c * d - s * b);
      off_[k] = c * (c * b + s * d) - s * (c * a + s * b);
      if (k + 1 < last) {
        x = off_[k];
        bulge = s * off_[k + 1];
        off_[k + 1] *= c;
      }
      Q_.applyOnTheRight(k, k + 1, Eigen::JacobiRotation<double>(c, -s));
    }
  }

  MatrixPairs Lowest(Index pairs) const {
    std::vector<Index> order(n_);
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) {
      return diagonal_[i] < diagonal_[j];
    });
    order.resize(pairs);
    return MatrixPairs{diagonal_(order), Q_(Eigen::all, order)};
  }

  const Index n_;
  const Index rows_;  // of Q, the last ones
  const CancelToken& cancel_;
  Eigen::MatrixXd A_;         // its lower half; then the reflections
  Eigen::VectorXd diagonal_;  // of T
  Eigen::VectorXd off_;       // T's entries beside the diagonal
  Eigen::MatrixXd Q_;
};

}  // namespace

absl::StatusOr<MatrixPairs> SolveDensely(
    const Eigen::SparseMatrix<double>& matrix, int pairs,
    const CancelToken& cancel) {
  return DenseSolver(matrix, matrix.rows(), cancel).Solve(pairs);
}

absl::StatusOr<MatrixPairs> SolveForLastRows(Eigen::MatrixXd matrix, Index rows,
                                             const CancelToken& cancel) {
  const Index n = matrix.rows();
  return DenseSolver(std::move(matrix), rows, cancel).Solve(n);
}

// Two vectors that had shares a and b of the constant one overlap by -a b
// without them: those with a share that matters are parted from each other.
void RemoveConstant(Eigen::VectorXd constant, Eigen::MatrixXd& vectors) {
  constexpr double kLeastShare = 1e-8;
  constant.normalize();
  std::vector<Index> mixed;
  for (Index k = 1; k < vectors.cols(); ++k) {
    auto v = vectors.col(k);
    const double share = constant.dot(v);
    v -= share * constant;
    if (std::abs(share) > kLeastShare) {
      for (Index other : mixed)
        v -= vectors.col(other).dot(v) * vectors.col(other);
      mixed.push_back(k);
    }
    v.normalize();
  }
}

}  // namespace marrow
