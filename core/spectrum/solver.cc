// Why shift-invert: the lowest eigenvalues of L x = lambda M x lie close
// together and far from the highest, so plain Lanczos would take thousands of
// steps. With the operator (L - sigma M)^-1 they are the largest, well apart.
// sigma is a little below zero, so that the matrix is positive definite and one
// Cholesky factorisation serves every step.
#include "core/spectrum/solver.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/operators/laplacian.h"

namespace marrow {
namespace {

constexpr double kShift = -0.01;
// Up to this size a dense solver is quicker, and always finds everything.
constexpr int kDenseVertices = 500;
constexpr double kLanczosTolerance = 1e-10;
constexpr int kMaxRestarts = 100;
// In units of max(lambda, lambda_1): what a pair may be off at most.
constexpr double kMaxResidual = 1e-6;

// Leaves Spectra's loop; never leaves this file.
struct Cancelled : std::exception {};

// y = M^1/2 (L - sigma M)^-1 M^1/2 x, the symmetric form of the problem.
class ShiftInvertOperator {
 public:
  using Scalar = double;

  ShiftInvertOperator(const Laplacian& laplacian, double expected_steps,
                      const CancelToken& cancel,
                      const ProgressCallback& progress)
      : laplacian_(laplacian),
        sqrt_mass_(laplacian.M.cwiseSqrt()),
        expected_steps_(expected_steps),
        cancel_(cancel),
        progress_(progress) {}

  Eigen::Index rows() const { return laplacian_.L.rows(); }
  Eigen::Index cols() const { return laplacian_.L.cols(); }

  void set_shift(double sigma) {
    Eigen::SparseMatrix<double> shifted = laplacian_.L;
    shifted.diagonal() -= sigma * laplacian_.M;
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
    out = sqrt_mass_.cwiseProduct(cholesky_.solve(sqrt_mass_.cwiseProduct(in)));
  }
  const Eigen::VectorXd& sqrt_mass() const { return sqrt_mass_; }

 private:
  const Laplacian& laplacian_;
  Eigen::VectorXd sqrt_mass_;
  double expected_steps_;
  const CancelToken& cancel_;
  const ProgressCallback& progress_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky_;
  bool factorised_ = false;
  mutable double steps_ = 0;
};

absl::Status NotConverged(uint32_t converged, uint32_t wanted) {
  return WithReason(
      absl::InternalError(absl::StrCat("the eigensolver found ", converged,
                                       " of ", wanted, " eigen-pairs")),
      kReasonSolverNotConverged);
}

struct RawPairs {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // M-orthonormal columns
};

RawPairs SolveDense(const Laplacian& laplacian, uint32_t pairs) {
  const Eigen::VectorXd inverse_sqrt = laplacian.M.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd symmetric = inverse_sqrt.asDiagonal() *
                                    Eigen::MatrixXd(laplacian.L) *
                                    inverse_sqrt.asDiagonal();
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  return {solver.eigenvalues().head(pairs),
          inverse_sqrt.asDiagonal() * solver.eigenvectors().leftCols(pairs)};
}

absl::StatusOr<RawPairs> SolveLanczos(const Laplacian& laplacian,
                                      uint32_t pairs, const CancelToken& cancel,
                                      const ProgressCallback& progress) {
  const int n = static_cast<int>(laplacian.L.rows());
  const int basis = std::min(n, static_cast<int>(2 * pairs + 1));
  ShiftInvertOperator op(laplacian, 1.25 * basis, cancel, progress);
  try {
    Spectra::SymEigsShiftSolver<ShiftInvertOperator> solver(op, pairs, basis,
                                                            kShift);
    if (!op.factorised()) return NotConverged(0, pairs);
    solver.init();
    const auto converged =
        solver.compute(Spectra::SortRule::LargestMagn, kMaxRestarts,
                       kLanczosTolerance, Spectra::SortRule::SmallestAlge);
    if (solver.info() != Spectra::CompInfo::Successful)
      return NotConverged(converged, pairs);
    return RawPairs{
        solver.eigenvalues(),
        op.sqrt_mass().cwiseInverse().asDiagonal() * solver.eigenvectors()};
  } catch (const Cancelled&) {
    return cancel.Check();
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError(absl::StrCat(
        "not enough memory for ", pairs, " eigen-pairs of ", n, " vertices"));
  } catch (const std::exception& e) {
    return absl::InternalError(absl::StrCat("the eigensolver: ", e.what()));
  }
}

// In the M^-1 norm, over max(lambda, lambda_1).
absl::Status CheckResiduals(const Laplacian& laplacian, const RawPairs& raw) {
  const double floor = raw.values.size() > 1 ? raw.values[1] : 1.0;
  for (Eigen::Index k = 0; k < raw.values.size(); ++k) {
    const Eigen::VectorXd residual =
        laplacian.L * raw.vectors.col(k) -
        raw.values[k] * laplacian.M.cwiseProduct(raw.vectors.col(k));
    const double norm =
        std::sqrt(residual.cwiseAbs2().cwiseQuotient(laplacian.M).sum());
    if (!(norm <= kMaxResidual * std::max(raw.values[k], floor)))
      return NotConverged(static_cast<uint32_t>(k),
                          static_cast<uint32_t>(raw.values.size()));
  }
  return absl::OkStatus();
}

// The entry of largest magnitude (the first, where several are) is positive.
void FixSigns(Eigen::MatrixXd& vectors) {
  for (Eigen::Index k = 0; k < vectors.cols(); ++k) {
    Eigen::Index at;
    vectors.col(k).cwiseAbs().maxCoeff(&at);
    if (vectors(at, k) < 0) vectors.col(k) = -vectors.col(k);
  }
}

}  // namespace

absl::StatusOr<std::shared_ptr<const EigenPairs>> SolverEigenPairSource::Get(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress) {
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const uint32_t n = mesh.mesh.NumVertices();
  const uint32_t pairs = std::min(count + 1, n);
  MARROW_ASSIGN_OR_RETURN(const Laplacian laplacian,
                          BuildLaplacian(mesh.mesh, cancel));
  MARROW_RETURN_IF_ERROR(cancel.Check());
  RawPairs raw;
  if (n <= kDenseVertices || 2 * pairs >= n) {
    raw = SolveDense(laplacian, pairs);
  } else {
    MARROW_ASSIGN_OR_RETURN(raw,
                            SolveLanczos(laplacian, pairs, cancel, progress));
  }
  MARROW_RETURN_IF_ERROR(CheckResiduals(laplacian, raw));
  FixSigns(raw.vectors);
  // The constant pair is known exactly.
  raw.values[0] = 0;
  raw.vectors.col(0).setOnes();

  auto result = std::make_shared<EigenPairs>();
  result->eigenvalues = std::move(raw.values);
  result->eigenvectors = raw.vectors;
  result->area = mesh.report.area;
  result->complete = pairs == n;
  if (progress) progress(1);
  return result;
}

double PredictSolverSeconds(uint64_t vertices, uint32_t count) {
  // Orthogonalisation of the basis, and a solve a step.
  const double n = static_cast<double>(vertices);
  return 0.05 + n * (4e-9 * count * count + 2.5e-7 * count + 1e-6);
}

uint64_t PredictSolverBytes(uint64_t vertices, uint32_t count) {
  // The basis is twice the pairs and one; the pairs are held in two layouts;
  // the factor takes about 1 KiB a vertex.
  return vertices * (sizeof(double) * 5 * (uint64_t{count} + 1) + 1024);
}

}  // namespace marrow
