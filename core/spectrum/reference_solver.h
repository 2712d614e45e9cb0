// A second eigensolver, slower and from a library: what tests compare with, and
// what is left where spectrum slicing does not certify its result.
#ifndef MARROW_CORE_SPECTRUM_REFERENCE_SOLVER_H_
#define MARROW_CORE_SPECTRUM_REFERENCE_SOLVER_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"

namespace marrow {

// Pairs of a symmetric matrix: values ascending, vectors orthonormal columns.
struct MatrixPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

// The lowest pairs of a positive semi-definite matrix to about 1e-10, by
// Spectra's shift-invert Lanczos over Eigen's sparse Cholesky. Takes 8 bytes a
// row and pair four times over. `progress` is called with a share of the work.
// Errors: CANCELLED; INTERNAL with reason SOLVER_NOT_CONVERGED;
// RESOURCE_EXHAUSTED. REQUIRES: 2 * pairs < matrix.rows().
absl::StatusOr<MatrixPairs> SolveByReference(
    const Eigen::SparseMatrix<double>& matrix, int pairs,
    const CancelToken& cancel, const std::function<void(double)>& progress);

// All pairs by a dense solver, of which the lowest are returned. O(n^3).
MatrixPairs SolveDensely(const Eigen::SparseMatrix<double>& matrix, int pairs);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_REFERENCE_SOLVER_H_
