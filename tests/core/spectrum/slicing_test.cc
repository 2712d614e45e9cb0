// No pair is missed and none is there twice: against a dense solver, on shapes
// with high symmetry and on the same shapes stretched.
#include "core/spectrum/slicing.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "core/operators/laplacian.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// MARROW_SOLVES asks for more of them than a usual test run has time for.
int NumSolves() {
  const char* wanted = std::getenv("MARROW_SOLVES");
  return wanted != nullptr ? std::atoi(wanted) : 15;
}

std::vector<NamedMesh> SymmetricShapes() {
  return {{"icosphere", Icosphere(3)},
          {"cube", CubesSurface({{0, 0, 0}}, 10)},
          {"torus", Torus(2, 0.8, 36, 18)},
          {"square", Grid(24, 24)},
          {"cross", LimbCross(3)}};
}

Eigen::SparseMatrix<double> SymmetricForm(const TriangleMesh& mesh) {
  const Laplacian laplacian = *BuildLaplacian(mesh);
  const Eigen::VectorXd scale = laplacian.M.cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * laplacian.L * scale.asDiagonal();
}

std::vector<double> Sliced(const TriangleMesh& mesh,
                           const Eigen::SparseMatrix<double>& A, int pairs,
                           const SlicingOptions& options) {
  const CancelToken cancel;
  const auto slicer =
      *SpectrumSlicer::Create(A, mesh.positions.data(), pairs, options, cancel);
  const auto parts = slicer->Find({pairs}, cancel, [](double) {});
  EXPECT_TRUE(parts.ok()) << parts.status();
  std::vector<double> values;
  for (const SpectrumPart& part : *parts)
    values.insert(values.end(), part.band.values.begin() + part.first,
                  part.band.values.begin() + part.end);
  return values;
}

void ExpectTheLowest(const TriangleMesh& mesh, int pairs,
                     const SlicingOptions& options) {
  const Eigen::SparseMatrix<double> A = SymmetricForm(mesh);
  const std::vector<double> found = Sliced(mesh, A, pairs, options);
  const Eigen::VectorXd exact = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                    Eigen::MatrixXd(A), Eigen::EigenvaluesOnly)
                                    .eigenvalues();
  ASSERT_GE(found.size(), static_cast<size_t>(pairs));
  ASSERT_LE(found.size(), static_cast<size_t>(exact.size()));
  for (size_t k = 1; k < found.size(); ++k)
    ASSERT_NEAR(found[k] / exact[k], 1, 1e-5) << k;
}

TEST(SlicingTest, NoPairIsMissedOrDoubled) {
  const std::vector<NamedMesh> shapes = SymmetricShapes();
  const int solves = NumSolves(), count = static_cast<int>(shapes.size());
  for (int i = 0; i < solves; ++i) {
    const NamedMesh& shape = shapes[i % count];
    SCOPED_TRACE(shape.name + ", solve " + std::to_string(i));
    std::mt19937 random(i);
    TriangleMesh mesh = CanonicalOf(shape.mesh).mesh;
    if (i >= count) {
      for (int axis = 0; axis < 3; ++axis)
        mesh.positions.col(axis) *= 1 + 0.25 * (random() % 5);
      mesh = CanonicalOf(mesh).mesh;
    }
    const int n = static_cast<int>(mesh.NumVertices());
    ASSERT_GT(n, 500);
    const int pairs = 20 + static_cast<int>(random() % (n / 2 - 20));
    ExpectTheLowest(mesh, pairs, SlicingOptions());
  }
}

TEST(SlicingTest, FiveHundredPairs) {
  ExpectTheLowest(CanonicalOf(Torus(2, 0.8, 48, 24)).mesh, 501,
                  SlicingOptions());
}

TEST(SlicingTest, TheSameValuesAtAnyNumberOfThreads) {
  const TriangleMesh mesh = CanonicalOf(LimbCross(4)).mesh;
  const Eigen::SparseMatrix<double> A = SymmetricForm(mesh);
  SlicingOptions options;
  options.threads = 1;
  const std::vector<double> alone = Sliced(mesh, A, 120, options);
  for (int threads : {2, 3}) {
    options.threads = threads;
    EXPECT_EQ(Sliced(mesh, A, 120, options), alone) << threads;
  }
}

TEST(SlicingTest, StopsWhereWhatIsWantedIsThere) {
  const TriangleMesh mesh = CanonicalOf(LimbCross(4)).mesh;
  const Eigen::SparseMatrix<double> A = SymmetricForm(mesh);
  const CancelToken cancel;
  const auto slicer = *SpectrumSlicer::Create(A, mesh.positions.data(), 120,
                                              SlicingOptions(), cancel);
  const auto first = *slicer->Find({120, 0.0}, cancel, [](double) {});
  ASSERT_EQ(first.size(), 1u);
  const double beyond = first[0].band.values.back();
  EXPECT_TRUE(
      slicer->Find({120, 0.9 * beyond}, cancel, [](double) {})->empty());
  const auto more = *slicer->Find({120, beyond}, cancel, [](double) {});
  ASSERT_FALSE(more.empty());
  EXPECT_GT(more[0].band.values[more[0].first], beyond);
}

}  // namespace
}  // namespace marrow
