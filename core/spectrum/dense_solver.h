// All eigen-pairs of a small symmetric matrix.
#ifndef MARROW_CORE_SPECTRUM_DENSE_SOLVER_H_
#define MARROW_CORE_SPECTRUM_DENSE_SOLVER_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"

namespace marrow {

// Pairs of a symmetric matrix: values ascending, vectors orthonormal columns.
struct MatrixPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

// All pairs by a dense solver, of which the lowest are returned. O(n^3).
// Deterministic. Errors: CANCELLED; INTERNAL with reason SOLVER_NOT_CONVERGED.
absl::StatusOr<MatrixPairs> SolveDensely(
    const Eigen::SparseMatrix<double>& matrix, int pairs,
    const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_DENSE_SOLVER_H_
