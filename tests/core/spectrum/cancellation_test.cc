// Every phase of a solve stops soon after it is cancelled, wherever it is.
#include <memory>

#include "core/operators/laplacian.h"
#include "core/spectrum/band_lanczos.h"
#include "core/spectrum/certified_spectrum.h"
#include "core/spectrum/dense_solver.h"
#include "core/spectrum/inverse_iteration.h"
#include "core/spectrum/shift_grid.h"
#include "core/spectrum/solver.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"
#include "tests/testing/slowest_stop.h"

namespace marrow {
namespace {

// What a phase may go on for, all its threads together.
const double kMostSeconds = Allowed(0.1);

// 163,842 vertices, and what the later phases begin with.
class CancellationTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    mesh_ = new CanonicalMesh(CanonicalOf(Icosphere(7)));
    const Laplacian laplacian = *BuildLaplacian(mesh_->mesh);
    const Eigen::VectorXd scale = laplacian.M.cwiseSqrt().cwiseInverse();
    A_ = new Eigen::SparseMatrix<double>(scale.asDiagonal() * laplacian.L *
                                         scale.asDiagonal());
    structure_ = new SupernodalStructure(*Analyse(CancelToken()));
  }
  static void TearDownTestSuite() {
    delete structure_;
    delete A_;
    delete mesh_;
  }

  static absl::StatusOr<SupernodalStructure> Analyse(
      const CancelToken& cancel) {
    return AnalyseStructure(*A_, mesh_->mesh.positions.data(), size_t{1} << 30,
                            2, cancel);
  }

  static CanonicalMesh* mesh_;
  static Eigen::SparseMatrix<double>* A_;
  static SupernodalStructure* structure_;
};

CanonicalMesh* CancellationTest::mesh_ = nullptr;
Eigen::SparseMatrix<double>* CancellationTest::A_ = nullptr;
SupernodalStructure* CancellationTest::structure_ = nullptr;

TEST_F(CancellationTest, Operator) {
  EXPECT_LT(SlowestStop(kMostSeconds, 0.03, 0.4,
                        [](const CancelToken& cancel) {
                          return BuildLaplacian(mesh_->mesh, cancel).status();
                        }),
            kMostSeconds);
}

TEST_F(CancellationTest, OrderingAndAnalysis) {
  EXPECT_LT(SlowestStop(kMostSeconds, 0.13, 0.7,
                        [](const CancelToken& cancel) {
                          return Analyse(cancel).status();
                        }),
            kMostSeconds);
}

TEST_F(CancellationTest, Factorisation) {
  SupernodalFactor factor(*structure_);
  Team team(2);
  EXPECT_LT(SlowestStop(kMostSeconds, 0.05, 0.3,
                        [&](const CancelToken& cancel) {
                          return factor.Compute(100.0, team, cancel);
                        }),
            kMostSeconds);
}

TEST_F(CancellationTest, Lanczos) {
  SupernodalFactor factor(*structure_);
  Team team(2);
  ASSERT_TRUE(FactoriseNear(100, factor, team, CancelToken()).ok());
  BandRequest request;
  request.below = factor.negative_pivots();
  request.all_below = request.any_end_below = true;
  request.above = 6;
  request.tolerance = 1e-4;
  LanczosWorkspace workspace;
  EXPECT_LT(SlowestStop(kMostSeconds, 0.35, 1.2,
                        [&](const CancelToken& cancel) {
                          return FindBand(*structure_, factor, request,
                                          workspace, team, cancel, [] {})
                              .status();
                        }),
            kMostSeconds);
}

TEST_F(CancellationTest, Refinement) {
  SupernodalFactor factor(*structure_);
  Team team(2);
  ASSERT_TRUE(FactoriseNear(100, factor, team, CancelToken()).ok());
  EXPECT_LT(SlowestStop(kMostSeconds, 0.15, 0.7,
                        [&](const CancelToken& cancel) {
                          Window window;
                          window.values.setZero(32);
                          window.vectors.setRandom(structure_->n, 32);
                          return IterateInversely(factor, window, cancel);
                        }),
            kMostSeconds);
}

TEST_F(CancellationTest, Certification) {
  const auto pairs =
      SolverEigenPairSource().Get(*mesh_, 10, CancelToken(), nullptr);
  EXPECT_LT(SlowestStop(kMostSeconds, 0.4, 1.4,
                        [&](const CancelToken& cancel) {
                          return CertifySpectrum(*mesh_, **pairs, 10,
                                                 kStrictResidual, cancel,
                                                 nullptr)
                              .status();
                        }),
            kMostSeconds);
}

TEST_F(CancellationTest, DenseSolver) {
  const CanonicalMesh small = CanonicalOf(Icosphere(3));
  EXPECT_LT(SlowestStop(kMostSeconds, 0.08, 0.5,
                        [&](const CancelToken& cancel) {
                          return SolverEigenPairSource()
                              .Get(small, 1000, cancel, nullptr)
                              .status();
                        }),
            kMostSeconds);
}

}  // namespace
}  // namespace marrow
