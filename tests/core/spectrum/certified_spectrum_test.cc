#include "core/spectrum/certified_spectrum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/base/error_reason.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/solver.h"
#include "core/spectrum/strict_solver.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

struct Solved {
  CanonicalMesh mesh;
  std::shared_ptr<const EigenPairs> pairs;
};

Solved Solve(const TriangleMesh& mesh, uint32_t count, double tolerance) {
  Solved solved{CanonicalOf(mesh), nullptr};
  const CancelToken cancel;
  solved.pairs = SolverEigenPairSource(tolerance)
                     .Get(solved.mesh, count, cancel, nullptr)
                     .value();
  return solved;
}

CertifiedSpectrum Strict(const TriangleMesh& mesh, uint32_t count) {
  return SolveStrictly(CanonicalOf(mesh), count, CancelToken(), nullptr)
      .value();
}

CertifiedSpectrum Refined(const TriangleMesh& mesh, uint32_t count) {
  const Solved solved =
      Solve(mesh, WithStrictGuards(count), kStrictSolverTolerance);
  return CertifySpectrum(solved.mesh, *solved.pairs, count, kStrictResidual,
                         CancelToken(), nullptr)
      .value();
}

double WorstOrthonormality(const Laplacian& laplacian,
                           const CertifiedSpectrum& spectrum) {
  const Eigen::MatrixXd products = spectrum.eigenvectors.transpose() *
                                   laplacian.M.asDiagonal() *
                                   spectrum.eigenvectors;
  return (products -
          Eigen::MatrixXd::Identity(products.rows(), products.cols()))
      .cwiseAbs()
      .maxCoeff();
}

// The residuals as the header defines them, from their definition.
Eigen::VectorXd Residuals(const Laplacian& laplacian,
                          const CertifiedSpectrum& spectrum) {
  const Eigen::MatrixXd rest = laplacian.L * spectrum.eigenvectors -
                               laplacian.M.asDiagonal() *
                                   spectrum.eigenvectors *
                                   spectrum.eigenvalues.asDiagonal();
  return (laplacian.M.cwiseSqrt().cwiseInverse().asDiagonal() * rest)
      .colwise()
      .norm()
      .transpose()
      .cwiseQuotient(spectrum.eigenvalues.cwiseMax(spectrum.eigenvalues[1]));
}

void ExpectStrict(const TriangleMesh& mesh, const CertifiedSpectrum& spectrum) {
  const CanonicalMesh canonical = CanonicalOf(mesh);
  const Laplacian laplacian = *BuildLaplacian(canonical.mesh);
  EXPECT_EQ(spectrum.eigenvalues[0], 0);
  EXPECT_EQ(spectrum.area, canonical.report.area);
  EXPECT_LE(spectrum.residuals.maxCoeff(), kStrictResidual);
  EXPECT_LE((Residuals(laplacian, spectrum) - spectrum.residuals)
                .cwiseAbs()
                .maxCoeff(),
            1e-10);
  EXPECT_LE(WorstOrthonormality(laplacian, spectrum), 1e-10);
  EXPECT_TRUE((spectrum.eigenvectors.col(0).array() == 1).all());
  for (uint32_t k = 0; k < spectrum.NumPairs(); ++k) {
    Eigen::Index at;
    spectrum.eigenvectors.col(k).cwiseAbs().maxCoeff(&at);
    EXPECT_GT(spectrum.eigenvectors(at, k), 0) << k;
  }
}

// That the bound is where the header says, by a solver that knows all.
void ExpectCounted(const TriangleMesh& mesh,
                   const CertifiedSpectrum& spectrum) {
  const Laplacian laplacian = *BuildLaplacian(CanonicalOf(mesh).mesh);
  const Eigen::VectorXd exact =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
          Eigen::MatrixXd(laplacian.L),
          Eigen::MatrixXd(laplacian.M.asDiagonal()), Eigen::EigenvaluesOnly)
          .eigenvalues();
  EXPECT_EQ((exact.array() < spectrum.bound).count(),
            spectrum.count_below_bound);
  EXPECT_EQ((spectrum.eigenvalues.array() < spectrum.bound).count(),
            spectrum.count_below_bound);
  for (uint32_t k = 1; k < spectrum.NumPairs(); ++k)
    EXPECT_NEAR(spectrum.eigenvalues[k] / exact[k], 1, 1e-9) << k;
}

TEST(CertifiedSpectrumTest, StrictPairsAreStrictOnAllKindsOfShapes) {
  const std::vector<NamedMesh> shapes = {
      {"cube", CubesSurface({{0, 0, 0}}, 10)},
      {"book", Book(10, 60)},
      {"torus", Torus(1, 0.4, 40, 20)},
      {"slivers", WithSlivers(Icosphere(3), 3, 1e-4)},
      {"two spheres", Apart(Icosphere(3), Icosphere(2))}};
  for (const auto& [name, mesh] : shapes) {
    SCOPED_TRACE(name);
    for (const auto& solve : {Strict, Refined}) {
      const CertifiedSpectrum spectrum = solve(mesh, 100);
      ASSERT_EQ(spectrum.NumPairs(), 101u);
      ExpectStrict(mesh, spectrum);
    }
  }
}

// Length 1000, radius 1: as a string, its pairs are those of half waves.
TEST(CertifiedSpectrumTest, StrictPairsOfALongTubeAreAllThere) {
  constexpr uint32_t kAround = 8, kRings = 201, kPairs = 200;
  TriangleMesh mesh;
  mesh.positions.resize(kAround * kRings, 3);
  for (uint32_t v = 0; v < kAround * kRings; ++v) {
    const double angle = 2 * std::numbers::pi * (v % kAround) / kAround;
    mesh.positions.row(v) << std::cos(angle), std::sin(angle),
        5.0 * (v / kAround);
  }
  for (uint32_t v = 0; v + kAround < kAround * kRings; ++v) {
    const uint32_t next = v / kAround * kAround + (v + 1) % kAround;
    mesh.faces.push_back({v, next, next + kAround});
    mesh.faces.push_back({v, next + kAround, v + kAround});
  }
  const CertifiedSpectrum spectrum = Strict(mesh, kPairs);
  ASSERT_EQ(spectrum.NumPairs(), kPairs + 1);
  ExpectStrict(mesh, spectrum);
  EXPECT_TRUE(
      std::is_sorted(spectrum.eigenvalues.begin(), spectrum.eigenvalues.end()));
  for (uint32_t k = 1; k < 20; ++k) {
    const double wave = k * std::numbers::pi / 1000;
    EXPECT_NEAR(spectrum.eigenvalues[k] / (spectrum.area * wave * wave), 1,
                0.02)
        << k;
  }
}

// Bands end early here, and what is not found must not be made up.
TEST(CertifiedSpectrumTest, StrictPairsOfClustersAreStrictOrRefused) {
  TriangleMesh mesh = Icosphere(2);
  for (int i = 1; i < 12; ++i) mesh = Apart(mesh, Icosphere(2));
  for (uint32_t count : {20, 60, 200}) {
    SCOPED_TRACE(count);
    const auto spectrum =
        SolveStrictly(CanonicalOf(mesh), count, CancelToken(), nullptr);
    // Who asks is told by the residuals.
    if (spectrum.ok() && spectrum->residuals.maxCoeff() <= kStrictResidual) {
      ExpectStrict(mesh, *spectrum);
      EXPECT_TRUE(std::is_sorted(spectrum->eigenvalues.begin(),
                                 spectrum->eigenvalues.end()));
    } else if (!spectrum.ok()) {
      EXPECT_EQ(ReasonOf(spectrum.status()), kReasonSolverNotConverged)
          << spectrum.status();
    }
  }
}

TEST(CertifiedSpectrumTest, StrictPairsAreThoseThatADenseSolverFinds) {
  for (const TriangleMesh& mesh : {Icosphere(3), LimbCross(3)}) {
    for (const auto& solve : {Strict, Refined}) {
      const CertifiedSpectrum spectrum = solve(mesh, 150);
      ExpectStrict(mesh, spectrum);
      ExpectCounted(mesh, spectrum);
    }
  }
}

// Degree 3 of the sphere has the pairs 9 to 15: what comes after 11 of them
// cannot be counted before the first.
TEST(CertifiedSpectrumTest, CountsBelowAClusterThatIsCut) {
  const TriangleMesh sphere = Icosphere(3);
  const CertifiedSpectrum spectrum = Strict(sphere, 11);
  ExpectStrict(sphere, spectrum);
  ExpectCounted(sphere, spectrum);
  EXPECT_GE(spectrum.count_below_bound, 9u);
}

TEST(CertifiedSpectrumTest, SmallMeshesAreWhole) {
  for (const TriangleMesh& mesh :
       {SingleTriangle(), Tetrahedron(), Icosphere(1), Disk(4)}) {
    const CertifiedSpectrum spectrum = Strict(mesh, 200);
    EXPECT_EQ(spectrum.NumPairs(), mesh.NumVertices());
    EXPECT_TRUE(spectrum.complete);
    EXPECT_EQ(spectrum.count_below_bound, mesh.NumVertices());
    ExpectStrict(mesh, spectrum);
    ExpectCounted(mesh, spectrum);
  }
}

// The vectors lose in float what they were solved to.
TEST(CertifiedSpectrumTest, UsualPairsAreAsGoodAsBeforeRounding) {
  const TriangleMesh cross = LimbCross(6);
  const Solved solved = Solve(cross, 60, kSolverTolerance);
  const CancelToken cancel;
  const CertifiedSpectrum spectrum =
      CertifySpectrum(solved.mesh, *solved.pairs, 1000, kUsualResidual, cancel,
                      nullptr)
          .value();
  EXPECT_LE(spectrum.residuals.maxCoeff(), kUsualResidual);
  CertifiedSpectrum rounded = spectrum;
  rounded.eigenvectors = solved.pairs->eigenvectors.cast<double>();
  EXPECT_GT(Residuals(*BuildLaplacian(solved.mesh.mesh), rounded).maxCoeff(),
            kUsualResidual);
}

EigenPairs Without(const EigenPairs& pairs, uint32_t missing) {
  EigenPairs less = pairs;
  const Eigen::Index n = pairs.NumPairs();
  less.eigenvalues.resize(n - 1);
  less.eigenvectors.resize(pairs.eigenvectors.rows(), n - 1);
  less.eigenvalues << pairs.eigenvalues.head(missing),
      pairs.eigenvalues.tail(n - 1 - missing);
  less.eigenvectors << pairs.eigenvectors.leftCols(missing),
      pairs.eigenvectors.rightCols(n - 1 - missing);
  return less;
}

TEST(CertifiedSpectrumTest, AMissingPairIsNoticed) {
  const Solved solved = Solve(LimbCross(6), 120, kSolverTolerance);
  const CancelToken cancel;
  for (uint32_t missing : {1u, 20u, 57u, 118u}) {
    const auto spectrum =
        CertifySpectrum(solved.mesh, Without(*solved.pairs, missing), 1000,
                        kUsualResidual, cancel, nullptr);
    EXPECT_EQ(spectrum.status().code(), absl::StatusCode::kInternal) << missing;
    EXPECT_EQ(ReasonOf(spectrum.status()), kReasonSolverNotConverged);
  }
}

// In the place of another, so that the count fits.
TEST(CertifiedSpectrumTest, APairThatIsThereTwiceIsNoticed) {
  const Solved solved = Solve(LimbCross(6), 120, kSolverTolerance);
  const CancelToken cancel;
  for (uint32_t again : {3u, 61u, 119u}) {
    EigenPairs twice = *solved.pairs;
    twice.eigenvalues[again] = twice.eigenvalues[again - 1];
    twice.eigenvectors.col(again) = twice.eigenvectors.col(again - 1);
    const auto spectrum = CertifySpectrum(solved.mesh, twice, 1000,
                                          kUsualResidual, cancel, nullptr);
    EXPECT_EQ(spectrum.status().code(), absl::StatusCode::kInternal) << again;
    EXPECT_EQ(ReasonOf(spectrum.status()), kReasonSolverNotConverged);
  }
}

TEST(CertifiedSpectrumTest, StopsWhenCancelled) {
  const Solved solved = Solve(Icosphere(4), 60, kSolverTolerance);
  CancelToken cancel;
  const auto spectrum =
      CertifySpectrum(solved.mesh, *solved.pairs, 1000, kUsualResidual, cancel,
                      [&](double) { cancel.Cancel(); });
  EXPECT_EQ(spectrum.status().code(), absl::StatusCode::kCancelled);
}

TEST(CertifiedSpectrumTest, ProgressNeverFalls) {
  const Solved solved = Solve(Icosphere(4), 150, kSolverTolerance);
  const CancelToken cancel;
  std::vector<double> shares;
  ASSERT_TRUE(CertifySpectrum(solved.mesh, *solved.pairs, 1000, kUsualResidual,
                              cancel,
                              [&](double share) { shares.push_back(share); })
                  .ok());
  EXPECT_GT(shares.size(), 3u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1);
}

}  // namespace
}  // namespace marrow
