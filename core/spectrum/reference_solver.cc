// Why shift-invert: the lowest eigenvalues lie close together and far from the
// highest, so plain Lanczos would take thousands of steps. With the inverse of
// the matrix, shifted a little below zero so that it is positive definite, they
// are the largest and well apart.
#include "core/spectrum/reference_solver.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <exception>
#include <new>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"

namespace marrow {
namespace {

constexpr double kShift = -0.01;
constexpr double kTolerance = 1e-10;
constexpr int kMaxRestarts = 100;

// Leaves Spectra's loop; never leaves this file.
struct Cancelled : std::exception {};

class ShiftInvertOperator {
 public:
  using Scalar = double;

  ShiftInvertOperator(const Eigen::SparseMatrix<double>& matrix,
                      double expected_steps, const CancelToken& cancel,
                      const std::function<void(double)>& progress)
      : matrix_(matrix),
        expected_steps_(expected_steps),
        cancel_(cancel),
        progress_(progress) {}

  Eigen::Index rows() const { return matrix_.rows(); }
  Eigen::Index cols() const { return matrix_.cols(); }

  void set_shift(double sigma) {
    Eigen::SparseMatrix<double> shifted = matrix_;
    shifted.diagonal().array() -= sigma;
    cholesky_.compute(shifted);
    factorised_ = cholesky_.info() == Eigen::Success;
  }
  bool factorised() const { return factorised_; }

  void perform_op(const double* x, double* y) const {
    if (cancel_.IsCancelled()) throw Cancelled();
    // Restarts make the number of steps a guess: approach 1 without reaching.
    const double done = ++steps_ / expected_steps_;
    if (progress_) progress_(done < 0.9 ? done : 1 - 0.1 * 0.9 / done);
    const Eigen::Map<const Eigen::VectorXd> in(x, rows());
    Eigen::Map<Eigen::VectorXd> out(y, rows());
    out = cholesky_.solve(in);
  }

 private:
  const Eigen::SparseMatrix<double>& matrix_;
  double expected_steps_;
  const CancelToken& cancel_;
  const std::function<void(double)>& progress_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky_;
  bool factorised_ = false;
  mutable double steps_ = 0;
};

absl::Status NotConverged(Eigen::Index converged, int wanted) {
  return WithReason(
      absl::InternalError(absl::StrCat("the eigensolver found ", converged,
                                       " of ", wanted, " eigen-pairs")),
      kReasonSolverNotConverged);
}

}  // namespace

absl::StatusOr<MatrixPairs> SolveByReference(
    const Eigen::SparseMatrix<double>& matrix, int pairs,
    const CancelToken& cancel, const std::function<void(double)>& progress) {
  const int n = static_cast<int>(matrix.rows());
  const int basis = std::min(n, 2 * pairs + 1);
  ShiftInvertOperator op(matrix, 1.25 * basis, cancel, progress);
  try {
    Spectra::SymEigsShiftSolver<ShiftInvertOperator> solver(op, pairs, basis,
                                                            kShift);
    if (!op.factorised()) return NotConverged(0, pairs);
    solver.init();
    const auto converged =
        solver.compute(Spectra::SortRule::LargestMagn, kMaxRestarts, kTolerance,
                       Spectra::SortRule::SmallestAlge);
    if (solver.info() != Spectra::CompInfo::Successful)
      return NotConverged(converged, pairs);
    return MatrixPairs{solver.eigenvalues(), solver.eigenvectors()};
  } catch (const Cancelled&) {
    return cancel.Check();
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError(absl::StrCat(
        "not enough memory for ", pairs, " eigen-pairs of ", n, " vertices"));
  } catch (const std::exception& e) {
    return absl::InternalError(absl::StrCat("the eigensolver: ", e.what()));
  }
}

}  // namespace marrow
