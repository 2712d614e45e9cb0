// All eigen-pairs of a small symmetric matrix.
#ifndef MARROW_CORE_SPECTRUM_DENSE_SOLVER_H_
#define MARROW_CORE_SPECTRUM_DENSE_SOLVER_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"

namespace marrow {

inline constexpr int kDenseVertices = 500;

// Whether `pairs` of n are found by a dense solver: it is quicker for tiny
// meshes, and the only one for most of the pairs.
constexpr bool IsSolvedDensely(int n, int pairs) {
  return n <= kDenseVertices || 2 * int64_t{pairs} > n;
}

// Pairs of a symmetric matrix: values ascending, vectors orthonormal columns.
struct MatrixPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

// All pairs of a symmetric matrix, of which only the lower half is read, with
// the last `rows` rows of the vectors alone: O(n^3), but a small one where
// these are few. Deterministic. Errors: CANCELLED; INTERNAL with reason
// SOLVER_NOT_CONVERGED.
absl::StatusOr<MatrixPairs> SolveForLastRows(Eigen::MatrixXd matrix,
                                             Eigen::Index rows,
                                             const CancelToken& cancel);

// All pairs by a dense solver, of which the lowest are returned. O(n^3).
// Deterministic. Errors: CANCELLED; INTERNAL with reason SOLVER_NOT_CONVERGED.
absl::StatusOr<MatrixPairs> SolveDensely(
    const Eigen::SparseMatrix<double>& matrix, int pairs,
    const CancelToken& cancel);

// Makes the vectors but the first, whose pair is the constant one, orthogonal
// to `constant`, of any length: the solver leaves that to rounding, which is
// too much where values differ by many orders. They stay orthonormal.
void RemoveConstant(Eigen::VectorXd constant, Eigen::MatrixXd& vectors);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_DENSE_SOLVER_H_
