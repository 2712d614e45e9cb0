// Inverse iteration, and the repair of a band by it.
#include "core/spectrum/inverse_iteration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/base/error_reason.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/band_lanczos.h"
#include "core/spectrum/shift_grid.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

constexpr int kFirst = 20, kCount = 13;  // no whole number of blocks

Eigen::SparseMatrix<double> SymmetricForm(const TriangleMesh& mesh) {
  const Laplacian laplacian = *BuildLaplacian(mesh);
  const Eigen::VectorXd scale = laplacian.M.cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * laplacian.L * scale.asDiagonal();
}

// A mesh, all its pairs, and a factor amid those numbered from kFirst on.
class InverseIterationTest : public ::testing::Test {
 protected:
  InverseIterationTest()
      : mesh_(LimbCross(2)),
        A_(SymmetricForm(mesh_)),
        exact_(Eigen::MatrixXd(A_)),
        structure_(*AnalyseStructure(A_, mesh_.positions.data(),
                                     size_t{1} << 30, 2, CancelToken())),
        factor_(structure_) {
    // Nearer to all of them than to any other.
    const auto end = [&](int k) {
      return 0.5 * (exact_.eigenvalues()[k - 1] + exact_.eigenvalues()[k]);
    };
    Team team(1);
    const double shift = 0.5 * (end(kFirst) + end(kFirst + kCount));
    EXPECT_TRUE(factor_.Compute(shift, team, CancelToken()).ok());
  }

  // The exact pairs, with `noise` of other vectors in each.
  Window Spoilt(double noise) const {
    const Eigen::MatrixXd& all = exact_.eigenvectors();
    srand(5);
    Eigen::MatrixXd some = all.middleCols(kFirst, kCount) +
                           noise * all *
                               Eigen::MatrixXd::Random(all.cols(), kCount) /
                               std::sqrt(static_cast<double>(all.cols()));
    some.colwise().normalize();
    Window window;
    window.values.setZero(kCount);
    window.vectors =
        RowMajorMatrix::Zero(all.rows(), Window::PaddedWidth(kCount));
    for (int i = 0; i < structure_.n; ++i)
      window.vectors.row(i).head(kCount) = some.row(structure_.order[i]);
    return window;
  }

  // |A x - lambda x| / lambda at the worst of the pairs from `first` to `end`.
  double WorstResidual(const Window& window, int first, int end) const {
    Eigen::MatrixXd X(structure_.n, kCount);
    for (int i = 0; i < structure_.n; ++i)
      X.row(structure_.order[i]) = window.vectors.row(i).head(kCount);
    const Eigen::MatrixXd rest = A_ * X - X * window.values.asDiagonal();
    double worst = 0;
    for (int k = first; k < end; ++k)
      worst = std::max(worst, rest.col(k).norm() / window.values[k]);
    return worst;
  }

  const TriangleMesh mesh_;
  const Eigen::SparseMatrix<double> A_;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> exact_;
  const SupernodalStructure structure_;
  SupernodalFactor factor_;
};

// Those amid the window lose it soon, those at its ends slowly: neighbours
// beyond it are almost as near to the shift.
TEST_F(InverseIterationTest, TakesAwayWhatIsFarFromTheShift) {
  Window window = Spoilt(0.1);
  double last = HUGE_VAL;
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(IterateInversely(factor_, window, CancelToken()).ok());
    const double worst = WorstResidual(window, 0, kCount);
    EXPECT_LE(worst, 1.01 * last) << i;
    last = worst;
  }
  EXPECT_LT(last, 0.01);
  EXPECT_LT(WorstResidual(window, 4, kCount - 4), 1e-11);
  for (int k = 4; k < kCount - 4; ++k)
    EXPECT_NEAR(window.values[k] / exact_.eigenvalues()[kFirst + k], 1, 1e-11);
  const Eigen::MatrixXd gram = window.vectors.transpose() * window.vectors;
  EXPECT_LT((gram.topLeftCorner(kCount, kCount) -
             Eigen::MatrixXd::Identity(kCount, kCount))
                .cwiseAbs()
                .maxCoeff(),
            1e-11);
  EXPECT_EQ(window.vectors.rightCols(window.vectors.cols() - kCount).norm(), 0);
}

TEST_F(InverseIterationTest, AVectorThatIsThereTwiceIsNoticed) {
  Window window = Spoilt(1e-6);
  window.vectors.col(3) = window.vectors.col(8);
  const absl::Status status = IterateInversely(factor_, window, CancelToken());
  EXPECT_EQ(status.code(), absl::StatusCode::kInternal);
  EXPECT_EQ(ReasonOf(status), kReasonSolverNotConverged);
}

TEST_F(InverseIterationTest, StopsWhenCancelled) {
  Window window = Spoilt(0.1);
  CancelToken cancel;
  cancel.Cancel();
  EXPECT_EQ(IterateInversely(factor_, window, cancel).code(),
            absl::StatusCode::kCancelled);
}

// A square of triangles from very small ones to large ones.
TriangleMesh Graded() {
  TriangleMesh mesh = Grid(24, 24);
  for (double& x : mesh.positions.reshaped()) x = std::pow(x / 24, 10);
  return mesh;
}

// Entries of very different sizes leave Lanczos vectors with residuals that its
// own estimate knows nothing of, here 5e-7: the band is repaired, or is none.
TEST(BandRepairTest, ResidualsThatAreTooLargeAreIteratedAway) {
  const TriangleMesh mesh = Graded();
  const Eigen::SparseMatrix<double> A = SymmetricForm(mesh);
  const auto structure = *AnalyseStructure(A, mesh.positions.data(),
                                           size_t{1} << 30, 2, CancelToken());
  SupernodalFactor factor(structure);
  Team team(1);
  ASSERT_TRUE(FactoriseNear(300, factor, team, CancelToken()).ok());
  BandRequest request;
  request.below = request.above = 10;
  request.tolerance = 1e-7;
  LanczosWorkspace workspace;
  const auto band = FindBand(structure, factor, request, workspace, team,
                             CancelToken(), [] {});
  ASSERT_TRUE(band.ok()) << band.status();
  for (double residual : band->residuals) EXPECT_LE(residual, 1e-7);
  const Eigen::VectorXd exact = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                    Eigen::MatrixXd(A), Eigen::EigenvaluesOnly)
                                    .eigenvalues();
  ASSERT_GE(band->values.size(), 20u);
  const int first = factor.negative_pivots() - band->below;
  for (size_t k = 0; k < band->values.size(); ++k)
    EXPECT_NEAR(band->values[k] / exact[first + k], 1, 1e-6) << k;
}

}  // namespace
}  // namespace marrow
