#include "core/spectrum/solver.h"

#include <Eigen/Eigenvalues>
#include <chrono>
#include <cstring>
#include <future>
#include <thread>
#include <vector>

#include "core/base/error_reason.h"
#include "core/operators/laplacian.h"
#include "gtest/gtest.h"
#include "tests/testing/hostile_meshes.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// A thousand cones that share their tip: as many eigenvalues are equal.
TriangleMesh Cones() {
  for (const HostileMesh& hostile : HostileMeshes(HostileSize::kReduced))
    if (hostile.name == "c67_cones") return hostile.make();
  return {};
}

using Clock = std::chrono::steady_clock;

// Tighter than what segmentation takes; the precision of float32 vectors.
constexpr double kTightTolerance = 1e-6;

std::shared_ptr<const EigenPairs> Solve(const CanonicalMesh& mesh,
                                        uint32_t count,
                                        double tolerance = kSolverTolerance) {
  const CancelToken cancel;
  return SolverEigenPairSource(tolerance)
      .Get(mesh, count, cancel, nullptr)
      .value();
}

Eigen::VectorXd DenseReference(const CanonicalMesh& mesh) {
  const Laplacian laplacian = *BuildLaplacian(mesh.mesh);
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
             Eigen::MatrixXd(laplacian.L),
             Eigen::MatrixXd(laplacian.M.asDiagonal()), Eigen::EigenvaluesOnly)
      .eigenvalues();
}

double WorstOrthonormality(const CanonicalMesh& mesh, const EigenPairs& pairs) {
  const Eigen::MatrixXd vectors = pairs.eigenvectors.cast<double>();
  const Eigen::MatrixXd products =
      vectors.transpose() * BuildLaplacian(mesh.mesh)->M.asDiagonal() * vectors;
  return (products -
          Eigen::MatrixXd::Identity(products.rows(), products.cols()))
      .cwiseAbs()
      .maxCoeff();
}

// In the M^-1 norm, in units of max(lambda, lambda_1).
double WorstResidual(const CanonicalMesh& mesh, const EigenPairs& pairs) {
  const Laplacian laplacian = *BuildLaplacian(mesh.mesh);
  double worst = 0;
  for (uint32_t k = 0; k < pairs.NumPairs(); ++k) {
    const Eigen::VectorXd phi = pairs.eigenvectors.col(k).cast<double>();
    const double lambda = pairs.eigenvalues[k];
    const Eigen::VectorXd residual =
        laplacian.L * phi - lambda * laplacian.M.cwiseProduct(phi);
    worst = std::max(
        worst,
        std::sqrt(residual.cwiseAbs2().cwiseQuotient(laplacian.M).sum()) /
            std::max(lambda, pairs.eigenvalues[1]));
  }
  return worst;
}

void ExpectSound(const CanonicalMesh& mesh, const EigenPairs& pairs,
                 double orthonormality = 1e-6) {
  ASSERT_EQ(pairs.eigenvectors.rows(), mesh.mesh.NumVertices());
  ASSERT_EQ(pairs.eigenvectors.cols(), pairs.eigenvalues.size());
  EXPECT_TRUE(pairs.eigenvectors.allFinite());
  EXPECT_EQ(pairs.eigenvalues[0], 0);
  for (uint32_t k = 1; k < pairs.NumPairs(); ++k) {
    EXPECT_GT(pairs.eigenvalues[k], 0);
    EXPECT_GE(pairs.eigenvalues[k], pairs.eigenvalues[k - 1]);
  }
  EXPECT_TRUE((pairs.eigenvectors.col(0).array() == 1).all());
  EXPECT_EQ(pairs.area, mesh.report.area);
  // Certified before the vectors were rounded to float32. What the rounding
  // adds to a residual grows with the largest eigenvalue of the mesh.
  EXPECT_LE(WorstOrthonormality(mesh, pairs), orthonormality);
  EXPECT_LE(WorstResidual(mesh, pairs), 2e-4);
}

TEST(SolverTest, LanczosMissesNoEigenvalue) {
  // All just above the size to which the solver is dense. Spheres have
  // clusters, the others closely lying eigenvalues.
  const std::vector<NamedMesh> shapes = {
      {"sphere", Icosphere(3)},
      {"cross", LimbCross(3)},
      {"book", Book(10, 60)},
      {"two spheres", Apart(Icosphere(3), Icosphere(2))}};
  for (const auto& [name, mesh] : shapes) {
    SCOPED_TRACE(name);
    const CanonicalMesh canonical = CanonicalOf(mesh);
    ASSERT_GT(canonical.mesh.NumVertices(), 500u);
    const auto pairs = Solve(canonical, 120, kTightTolerance);
    ASSERT_EQ(pairs->NumPairs(), 121u);
    EXPECT_FALSE(pairs->complete);
    ExpectSound(canonical, *pairs);
    const Eigen::VectorXd exact = DenseReference(canonical);
    for (int k = 1; k <= 120; ++k)
      EXPECT_NEAR(pairs->eigenvalues[k] / exact[k], 1, 1e-8) << k;
    const auto usual = Solve(canonical, 120);
    ExpectSound(canonical, *usual, kSolverTolerance);
    for (int k = 1; k <= 120; ++k)
      EXPECT_NEAR(usual->eigenvalues[k] / exact[k], 1, 1e-6) << k;
  }
}

TEST(SolverTest, FindsTheClustersOfTheSphereWhole) {
  const auto pairs = Solve(CanonicalOf(Icosphere(4)), 24);
  const Eigen::VectorXd lambda = pairs->eigenvalues / pairs->area;
  int k = 0;
  for (int l = 0; l <= 4; ++l)
    for (int m = -l; m <= l; ++m, ++k)
      EXPECT_NEAR(lambda[k], l * (l + 1), 0.3) << "degree " << l;
}

TEST(SolverTest, SmallMeshesHaveAsManyPairsAsVertices) {
  for (const auto& mesh :
       {SingleTriangle(), Tetrahedron(), Icosphere(1), Grid(3, 1)}) {
    const CanonicalMesh canonical = CanonicalOf(mesh);
    const auto pairs = Solve(canonical, 200);
    EXPECT_EQ(pairs->NumPairs(), mesh.NumVertices());
    EXPECT_TRUE(pairs->complete);
    ExpectSound(canonical, *pairs);
  }
  EXPECT_FALSE(Solve(CanonicalOf(Icosphere(1)), 40)->complete);
  EXPECT_TRUE(Solve(CanonicalOf(Icosphere(1)), 41)->complete);
}

TEST(SolverTest, ManyPairsOfAMeshThatBarelyHasThem) {
  const CanonicalMesh canonical = CanonicalOf(Icosphere(3));
  const auto pairs = Solve(canonical, 1000);
  EXPECT_EQ(pairs->NumPairs(), 642u);
  EXPECT_TRUE(pairs->complete);
  ExpectSound(canonical, *pairs);
}

class SolverOnAnyShape : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(SolverOnAnyShape, IsSound) {
  const CanonicalMesh canonical = CanonicalOf(GetParam().mesh);
  ExpectSound(canonical, *Solve(canonical, 50, kTightTolerance));
  ExpectSound(canonical, *Solve(canonical, 50), kSolverTolerance);
}

INSTANTIATE_TEST_SUITE_P(Shapes, SolverOnAnyShape,
                         ::testing::ValuesIn(AllShapes()),
                         [](const auto& info) {
                           return TestNameOf(info.param);
                         });

TEST(SolverTest, GivesTheSameBytesTwice) {
  const CanonicalMesh canonical = CanonicalOf(LimbCross(4));
  const auto a = Solve(canonical, 60), b = Solve(canonical, 60);
  ASSERT_EQ(a->Bytes(), b->Bytes());
  EXPECT_EQ(std::memcmp(a->eigenvalues.data(), b->eigenvalues.data(),
                        sizeof(double) * a->eigenvalues.size()),
            0);
  EXPECT_EQ(std::memcmp(a->eigenvectors.data(), b->eigenvectors.data(),
                        sizeof(float) * a->eigenvectors.size()),
            0);
}

TEST(SolverTest, AnyoneGetsTheSameFirstPairs) {
  const CanonicalMesh canonical = CanonicalOf(LimbCross(4));
  const auto all = Solve(canonical, 150);
  for (uint32_t count : {2, 11, 12, 40, 51, 100}) {
    const auto few = Solve(canonical, count);
    ASSERT_EQ(few->NumPairs(), count + 1);
    EXPECT_EQ(few->eigenvalues, all->eigenvalues.head(count + 1)) << count;
    EXPECT_EQ(few->eigenvectors, all->eigenvectors.leftCols(count + 1))
        << count;
  }
}

TEST(SolverTest, StreamsGoOnFromWhereTheyAre) {
  const CancelToken cancel;
  for (const auto& mesh : {LimbCross(4), Icosphere(1)}) {
    const CanonicalMesh canonical = CanonicalOf(mesh);
    const auto all = Solve(canonical, 130);
    SolverEigenPairSource source;
    const auto stream = source.Open(canonical, 130);
    uint32_t before = 0;
    for (double bound : {0.0, all->eigenvalues[1], all->eigenvalues[20], 1.0,
                         all->eigenvalues[25], HUGE_VAL}) {
      const auto pairs = *stream->UpTo(bound, cancel, nullptr);
      const uint32_t count = pairs->NumPairs();
      EXPECT_GE(count, before);
      before = count;
      if (count < all->NumPairs()) {
        EXPECT_GT(pairs->eigenvalues[count - 1], bound);
      }
      EXPECT_EQ(pairs->eigenvalues, all->eigenvalues.head(count)) << bound;
      EXPECT_EQ(pairs->eigenvectors, all->eigenvectors.leftCols(count))
          << bound;
      EXPECT_EQ(pairs->complete, all->complete);
    }
    EXPECT_EQ(before, all->NumPairs());
  }
}

// Where bands do not come to be, those before are kept, and the rest is taken
// from the reference solver: whatever the steps, the same bytes.

TEST(SolverTest, StreamsGoOnFromWhereTheyAreOnTheWayOut) {
  const CancelToken cancel;
  const CanonicalMesh canonical = CanonicalOf(Cones());
  const auto all = Solve(canonical, 60);
  EXPECT_FALSE(all->for_any_count);
  SolverEigenPairSource source;
  const auto stream = source.Open(canonical, 60);
  for (double bound : {0.0, all->eigenvalues[1], HUGE_VAL}) {
    const auto pairs = *stream->UpTo(bound, cancel, nullptr);
    const uint32_t count = pairs->NumPairs();
    EXPECT_EQ(pairs->eigenvalues, all->eigenvalues.head(count)) << bound;
    EXPECT_EQ(pairs->eigenvectors, all->eigenvectors.leftCols(count)) << bound;
  }
}

// The pages' eigenvalues are equal, and more than are asked for.
TEST(SolverTest, StreamsOfABoundEndBeforeAClusterThatIsTooLarge) {
  const CancelToken cancel;
  const CanonicalMesh mesh = CanonicalOf(Book(2'000, 1));
  SolverEigenPairSource source;
  const auto stream = source.Open(mesh, 60);
  for (double bound : {0.0, 0.0, 1e9}) {
    const auto pairs = *stream->UpTo(bound, cancel, nullptr);
    EXPECT_EQ(pairs->NumPairs(), 1u);
    EXPECT_EQ(pairs->cluster_end, 61u);
  }
  const auto pairs = *stream->UpTo(HUGE_VAL, cancel, nullptr);
  ASSERT_EQ(pairs->NumPairs(), 61u);
  EXPECT_EQ(pairs->eigenvectors, Solve(mesh, 60)->eigenvectors);
}

TEST(SolverTest, FewPairsAreFoundWithoutTheRest) {
  const CanonicalMesh canonical = CanonicalOf(LimbCross(4));
  const CancelToken cancel;
  SolverEigenPairSource source;
  const auto pairs = *source.Open(canonical, 200)->UpTo(0, cancel, nullptr);
  EXPECT_LT(pairs->NumPairs(), 20u);
}

TEST(SolverTest, ProgressRisesToOne) {
  for (const auto& mesh : {Icosphere(1), Icosphere(3)}) {
    std::vector<double> reports;
    const CancelToken cancel;
    ASSERT_TRUE(SolverEigenPairSource()
                    .Get(CanonicalOf(mesh), 40, cancel,
                         [&](double share) { reports.push_back(share); })
                    .ok());
    ASSERT_FALSE(reports.empty());
    EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
    EXPECT_GE(reports.front(), 0);
    EXPECT_EQ(reports.back(), 1);
  }
}

TEST(SolverTest, CancelledBeforehand) {
  CancelToken cancel;
  cancel.Cancel();
  const auto pairs = SolverEigenPairSource().Get(CanonicalOf(Icosphere(1)), 10,
                                                 cancel, nullptr);
  EXPECT_EQ(pairs.status().code(), absl::StatusCode::kCancelled);
}

// Cancels from another thread once the solver has come to `share`; the seconds
// from there to its return.
double SecondsToStop(const CanonicalMesh& mesh, uint32_t count, double share) {
  CancelToken cancel;
  std::promise<void> reached;
  bool told = false;
  Clock::time_point cancelled_at;
  std::thread canceller([&] {
    reached.get_future().wait();
    cancelled_at = Clock::now();
    cancel.Cancel();
  });
  const auto pairs =
      SolverEigenPairSource().Get(mesh, count, cancel, [&](double done) {
        if (done >= share && !told) {
          told = true;
          reached.set_value();
        }
      });
  const auto returned_at = Clock::now();
  if (!told) reached.set_value();
  canceller.join();
  EXPECT_EQ(pairs.status().code(), absl::StatusCode::kCancelled);
  return std::chrono::duration<double>(returned_at - cancelled_at).count();
}

TEST(SolverTest, StopsWithinHalfASecondOfBeingCancelled) {
  const CanonicalMesh mesh = CanonicalOf(Icosphere(5));
  EXPECT_LT(SecondsToStop(mesh, 200, 0.01), 0.5);
  EXPECT_LT(SecondsToStop(mesh, 200, 0.4), 0.5);
}

TEST(SolverTest, PredictionsGrowWithTheWork) {
  EXPECT_LT(PredictSolverSeconds(5'000, 200),
            PredictSolverSeconds(50'000, 200));
  EXPECT_LT(PredictSolverSeconds(5'000, 50), PredictSolverSeconds(5'000, 200));
  EXPECT_LT(PredictSolverBytes(5'000, 200), PredictSolverBytes(50'000, 200));
  EXPECT_LT(PredictSolverBytes(5'000, 50), PredictSolverBytes(5'000, 200));
  const auto pairs = Solve(CanonicalOf(Icosphere(3)), 100);
  EXPECT_GE(PredictSolverBytes(642, 100), pairs->Bytes());
}

}  // namespace
}  // namespace marrow
