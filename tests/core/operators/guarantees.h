// The promises of the operator, as one check for tests.
#ifndef MARROW_TESTS_CORE_OPERATORS_GUARANTEES_H_
#define MARROW_TESTS_CORE_OPERATORS_GUARANTEES_H_

#include <algorithm>
#include <cmath>

#include "core/operators/laplacian.h"
#include "gtest/gtest.h"

namespace marrow {

// Everything that laplacian.h promises of the operator of `mesh`, found by
// other means than CheckLaplacian(), and that CheckLaplacian() agrees.
inline void ExpectGuarantees(const TriangleMesh& mesh,
                             const Laplacian& laplacian) {
  const Eigen::SparseMatrix<double>& L = laplacian.L;
  const uint32_t n = mesh.NumVertices();
  ASSERT_EQ(L.rows(), n);
  ASSERT_EQ(laplacian.M.size(), n);
  const double scale = L.diagonal().maxCoeff();
  ASSERT_TRUE(std::isfinite(scale));
  EXPECT_GT(L.diagonal().minCoeff(), 0);
  const Eigen::SparseMatrix<double> difference =
      L - Eigen::SparseMatrix<double>(L.transpose());
  EXPECT_EQ(difference.norm(), 0);
  double most = -1;
  for (uint32_t j = 0; j < n; ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator it(L, j); it; ++it)
      if (it.row() != j) most = std::max(most, it.value());
  EXPECT_LE(most, 1e-14 * scale);
  const Eigen::VectorXd sums = L * Eigen::VectorXd::Ones(n);
  EXPECT_LE(sums.cwiseAbs().maxCoeff(), 1e-12 * scale);
  EXPECT_GT(laplacian.M.minCoeff(), 0);
  EXPECT_NEAR(laplacian.M.sum(), 1, 1e-12);
  EXPECT_LE(laplacian.report.mollification, kMaxMollification);
  EXPECT_LE(laplacian.report.flips, MaxFlips(3 * uint64_t{mesh.NumFaces()}));
  EXPECT_EQ(CheckLaplacian(laplacian), absl::OkStatus());
}

}  // namespace marrow

#endif  // MARROW_TESTS_CORE_OPERATORS_GUARANTEES_H_
