#include "core/spectrum/dense_solver.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Jacobi>
#include <cmath>
#include <utility>

#include "core/operators/laplacian.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

Eigen::SparseMatrix<double> SymmetricForm(const TriangleMesh& mesh) {
  const Laplacian laplacian = *BuildLaplacian(mesh);
  const Eigen::VectorXd scale = laplacian.M.cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * laplacian.L * scale.asDiagonal();
}

TEST(DenseSolverTest, AgreesWithEigens) {
  const CancelToken cancel;
  for (const TriangleMesh& mesh :
       {SingleTriangle(), Tetrahedron(), Icosphere(2), Grid(9, 7),
        WithSlivers(Icosphere(1), 3, 0.0), LimbCross(2)}) {
    const Eigen::SparseMatrix<double> A = SymmetricForm(mesh);
    SCOPED_TRACE(A.rows());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> exact{
        Eigen::MatrixXd(A)};
    const int n = static_cast<int>(A.rows());
    const MatrixPairs all = *SolveDensely(A, n, cancel);
    const double rounding = 1e-13 * exact.eigenvalues()[n - 1];
    EXPECT_LT((all.values - exact.eigenvalues()).cwiseAbs().maxCoeff(),
              rounding);
    EXPECT_LT((A * all.vectors - all.vectors * all.values.asDiagonal())
                  .cwiseAbs()
                  .maxCoeff(),
              rounding);
    EXPECT_LT((all.vectors.transpose() * all.vectors -
               Eigen::MatrixXd::Identity(n, n))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-13);
    const MatrixPairs some = *SolveDensely(A, n - 1, cancel);
    EXPECT_EQ(some.values, all.values.head(n - 1));
    EXPECT_EQ(some.vectors, all.vectors.leftCols(n - 1));
  }
}

TEST(DenseSolverTest, TheLastRowsAreThoseOfTheWhole) {
  const CancelToken cancel;
  const Eigen::MatrixXd A(SymmetricForm(Icosphere(2)));
  const MatrixPairs all = *SolveForLastRows(A, A.rows(), cancel);
  for (int rows : {1, 8}) {
    const MatrixPairs some = *SolveForLastRows(A, rows, cancel);
    EXPECT_EQ(some.values, all.values);
    ASSERT_EQ(some.vectors.rows(), rows);
    EXPECT_LT(
        (some.vectors - all.vectors.bottomRows(rows)).cwiseAbs().maxCoeff(),
        1e-12);
  }
}

TEST(DenseSolverTest, TrivialMatrices) {
  const CancelToken cancel;
  for (int n : {1, 2, 5}) {
    const MatrixPairs zero =
        *SolveDensely(Eigen::SparseMatrix<double>(n, n), n, cancel);
    EXPECT_EQ(zero.values, Eigen::VectorXd::Zero(n));
    EXPECT_EQ(zero.vectors, Eigen::MatrixXd::Identity(n, n));
  }
}

// Rounding mixes the constant vector with those above it, where the largest
// eigenvalue is 1e12 times the least.
TEST(DenseSolverTest, VectorsStayOrthonormalWithoutTheConstant) {
  const int n = 12;
  Eigen::MatrixXd vectors =
      SolveDensely(SymmetricForm(Icosphere(0)), n, CancelToken())->vectors;
  const Eigen::VectorXd constant = 3 * vectors.col(0);
  for (const auto& [k, angle] : {std::pair{1, 3e-3}, {2, 2e-2}, {7, 1e-6}})
    vectors.applyOnTheRight(
        0, k, Eigen::JacobiRotation<double>(std::cos(angle), std::sin(angle)));
  ASSERT_GT(std::abs(constant.dot(vectors.col(2))), 1e-2);
  RemoveConstant(constant, vectors);
  vectors.col(0) = constant.normalized();
  EXPECT_LT((vectors.transpose() * vectors - Eigen::MatrixXd::Identity(n, n))
                .cwiseAbs()
                .maxCoeff(),
            1e-13);
}

TEST(DenseSolverTest, StopsWhenCancelled) {
  CancelToken cancel;
  cancel.Cancel();
  EXPECT_EQ(
      SolveDensely(SymmetricForm(Icosphere(1)), 3, cancel).status().code(),
      absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace marrow
