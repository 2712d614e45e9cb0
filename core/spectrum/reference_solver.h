// A second eigensolver, slower and from a library: what tests compare with, and
// what is left where spectrum slicing does not certify its result.
#ifndef MARROW_CORE_SPECTRUM_REFERENCE_SOLVER_H_
#define MARROW_CORE_SPECTRUM_REFERENCE_SOLVER_H_

#include <Eigen/SparseCore>
#include <functional>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/dense_solver.h"

namespace marrow {

// The lowest pairs of a positive semi-definite matrix to about 1e-10, by
// Spectra's shift-invert Lanczos over Eigen's sparse Cholesky. Takes 8 bytes a
// row and pair four times over. `progress` is called with a share of the work.
// Errors: CANCELLED; INTERNAL with reason SOLVER_NOT_CONVERGED;
// RESOURCE_EXHAUSTED. REQUIRES: 2 * pairs < matrix.rows().
absl::StatusOr<MatrixPairs> SolveByReference(
    const Eigen::SparseMatrix<double>& matrix, int pairs,
    const CancelToken& cancel, const std::function<void(double)>& progress);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_REFERENCE_SOLVER_H_
