#include "core/spectrum/component_spectrum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/operators/bridges.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/solver.h"
#include "core/spectrum/strict_solver.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// Spheres of these radii in a row.
TriangleMesh Row(const std::vector<double>& radii, int subdivisions) {
  TriangleMesh row = Scaled(Icosphere(subdivisions), radii.front());
  for (size_t i = 1; i < radii.size(); ++i)
    row = Apart(row, Scaled(Icosphere(subdivisions), radii[i]));
  return row;
}

absl::StatusOr<CertifiedSpectrum> SolveUsually(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress) {
  auto pairs = SolverEigenPairSource().Get(mesh, count, cancel, nullptr);
  if (!pairs.ok()) return pairs.status();
  return CertifySpectrum(mesh, **pairs, count, kUsualResidual, cancel,
                         progress);
}

// Without the bridges that BuildLaplacian() joins components by.
Eigen::MatrixXd WithoutBridges(const TriangleMesh& mesh,
                               const Eigen::SparseMatrix<double>& L) {
  Eigen::MatrixXd apart = L;
  for (const auto& [a, b] : FindBridges(mesh)) {
    apart(a, b) += kBridgeWeight;
    apart(b, a) += kBridgeWeight;
    apart(a, a) -= kBridgeWeight;
    apart(b, b) -= kBridgeWeight;
  }
  return apart;
}

struct Case {
  TriangleMesh mesh;
  uint32_t count;
};

class ComponentSpectrumTest : public ::testing::TestWithParam<int> {
 protected:
  static Case CaseOf(int number) {
    switch (number) {
      case 0:  // twelve that are equal: 108 times and 132 times one eigenvalue
        return {Row(std::vector<double>(12, 1), 2), 100};
      case 1:  // the last pair is among equals of three components
        return {Row({1, 1, 1, 0.4, 2}, 2), 30};
      case 2:  // a small one has its first pairs far up
        return {Row({5, 0.3}, 2), 60};
      default:  // nothing but zeros
        return {Row(std::vector<double>(9, 1), 0), 6};
    }
  }
};

TEST_P(ComponentSpectrumTest, IsThatOfTheWhole) {
  const auto [mesh, count] = CaseOf(GetParam());
  const CanonicalMesh canonical = CanonicalOf(mesh);
  const Laplacian laplacian = *BuildLaplacian(canonical.mesh);
  const Eigen::VectorXd scale = laplacian.M.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd L = WithoutBridges(canonical.mesh, laplacian.L);
  const Eigen::MatrixXd A = scale.asDiagonal() * L * scale.asDiagonal();
  const Eigen::VectorXd expected =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly)
          .eigenvalues();
  for (const SpectrumSolver& solve :
       {SpectrumSolver(SolveUsually), SpectrumSolver(SolveStrictly)}) {
    const auto spectrum =
        SolveByComponents(canonical, count, solve, CancelToken(), nullptr);
    ASSERT_TRUE(spectrum.ok()) << spectrum.status();
    ASSERT_EQ(spectrum->NumPairs(), count + 1);
    const Eigen::VectorXd& values = spectrum->eigenvalues;
    EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
    for (uint32_t k = 0; k <= count; ++k)
      EXPECT_NEAR(values[k], expected[k], 1e-6 * expected[count + 1] + 1e-9)
          << k;
    const auto below = (expected.array() < spectrum->bound).count();
    if (spectrum->bound > 0) {
      EXPECT_EQ(spectrum->count_below_bound, below);
    }
    const Eigen::MatrixXd& phi = spectrum->eigenvectors;
    EXPECT_EQ((phi.col(0).array() - 1).abs().maxCoeff(), 0);
    const Eigen::MatrixXd products =
        phi.transpose() * laplacian.M.asDiagonal() * phi;
    EXPECT_LE((products - Eigen::MatrixXd::Identity(count + 1, count + 1))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-6);
    const Eigen::MatrixXd rest =
        L * phi - laplacian.M.asDiagonal() * phi * values.asDiagonal();
    const double unit = values[count] > 0 ? values[count] : 1;
    EXPECT_LE((scale.asDiagonal() * rest).colwise().norm().maxCoeff(),
              1e-4 * unit);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, ComponentSpectrumTest,
                         ::testing::Values(0, 1, 2, 3));

TEST(SolveByComponentsTest, FewerPairsAreTheFirstOnes) {
  const CanonicalMesh mesh = CanonicalOf(Row({1, 1, 0.7}, 3));
  const auto solve = [&](uint32_t count) {
    return SolveByComponents(mesh, count, SolveStrictly, CancelToken(), nullptr)
        .value();
  };
  const CertifiedSpectrum few = solve(40), many = solve(90);
  EXPECT_LE((few.eigenvalues - many.eigenvalues.head(41)).cwiseAbs().maxCoeff(),
            1e-9 * many.eigenvalues[90]);
}

TEST(SolveByComponentsTest, ACancelledSolveIsCancelled) {
  CancelToken cancel;
  cancel.Cancel();
  EXPECT_TRUE(
      absl::IsCancelled(SolveByComponents(CanonicalOf(Row({1, 1}, 3)), 40,
                                          SolveStrictly, cancel, nullptr)
                            .status()));
}

TEST(SolveByComponentsTest, AllPairsOfTinyOnes) {
  const auto spectrum =
      SolveByComponents(CanonicalOf(Row({1, 1, 2}, 0)), 1000, SolveStrictly,
                        CancelToken(), nullptr);
  ASSERT_TRUE(spectrum.ok()) << spectrum.status();
  EXPECT_EQ(spectrum->NumPairs(), 36u);
  EXPECT_TRUE(spectrum->complete);
}

}  // namespace
}  // namespace marrow
