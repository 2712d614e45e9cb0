// No pair is missed and none is there twice: against a dense solver, on shapes
// with high symmetry and on the same shapes stretched, from the lowest on and
// about any shift.
#include "core/spectrum/slicing.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "core/operators/laplacian.h"
#include "core/spectrum/band_lanczos.h"
#include "core/spectrum/shift_grid.h"
#include "core/spectrum/supernodal_factor.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// MARROW_SOLVES asks for more of them than a usual test run has time for.
int NumSolves() {
  const char* wanted = std::getenv("MARROW_SOLVES");
  return wanted != nullptr ? std::atoi(wanted) : 28;
}

std::vector<NamedMesh> SymmetricShapes() {
  return {{"icosphere", Icosphere(3)},
          {"cube", CubesSurface({{0, 0, 0}}, 10)},
          {"torus", Torus(2, 0.8, 36, 18)},
          {"square", Grid(24, 24)},
          {"cross", LimbCross(3)},
          {"fine torus", Torus(2, 0.8, 48, 24)},
          {"fine cube", CubesSurface({{0, 0, 0}}, 13)}};
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
  // Why there are too few comes with the next call.
  if (static_cast<int>(values.size()) < pairs) {
    ADD_FAILURE() << slicer->Find({pairs}, cancel, [](double) {}).status();
  }
  return values;
}

// A mesh and all its eigenvalues.
struct Problem {
  explicit Problem(const TriangleMesh& shape)
      : mesh(CanonicalOf(shape).mesh),
        A(SymmetricForm(mesh)),
        exact(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                  Eigen::MatrixXd(A), Eigen::EigenvaluesOnly)
                  .eigenvalues()) {}
  int n() const { return static_cast<int>(exact.size()); }

  TriangleMesh mesh;
  Eigen::SparseMatrix<double> A;
  Eigen::VectorXd exact;
};

// `found` are the pairs from number `first` on.
void ExpectPairsFrom(const Problem& problem, int first,
                     const std::vector<double>& found) {
  ASSERT_GE(first, 0);
  ASSERT_LE(first + found.size(), static_cast<size_t>(problem.n()));
  for (size_t i = first == 0 ? 1 : 0; i < found.size(); ++i)
    ASSERT_NEAR(found[i] / problem.exact[first + i], 1, 1e-5) << first + i;
}

void ExpectTheLowest(const Problem& problem, int pairs) {
  const std::vector<double> found =
      Sliced(problem.mesh, problem.A, pairs, SlicingOptions());
  ASSERT_GE(found.size(), static_cast<size_t>(pairs));
  ExpectPairsFrom(problem, 0, found);
}

// Pairs on both sides of a shift anywhere among the lowest `pairs`: the count
// at the shift is right, and what is found are the nearest, by that count.
void ExpectThoseAbout(const Problem& problem, int pairs, std::mt19937& random) {
  const CancelToken cancel;
  const auto structure = *AnalyseStructure(
      problem.A, problem.mesh.positions.data(), size_t{1} << 30, 2, cancel);
  SupernodalFactor factor(structure);
  Team team(2);
  const double share = random() / 4294967296.0;
  ASSERT_TRUE(
      FactoriseNear(share * problem.exact[pairs], factor, team, cancel).ok());
  const int below = factor.negative_pivots();
  ASSERT_EQ(below, (problem.exact.array() < factor.shift()).count());
  BandRequest request;
  request.tolerance = SlicingOptions().tolerance;
  request.above = 1 + static_cast<int>(random() % 30);
  request.below = std::min<int>(below, random() % (2 * request.above));
  request.all_below = request.any_end_below = request.below == below;
  LanczosWorkspace workspace;
  const auto band =
      FindBand(structure, factor, request, workspace, team, cancel, [] {});
  ASSERT_TRUE(band.ok()) << band.status();
  ASSERT_GE(band->below, request.below);
  ASSERT_GE(static_cast<int>(band->values.size()), band->below + request.above);
  ExpectPairsFrom(problem, below - band->below, band->values);
}

// The shape of a solve as it is, or stretched.
TriangleMesh ShapeOf(const TriangleMesh& shape, bool stretched,
                     std::mt19937& random) {
  TriangleMesh mesh = shape;
  for (int axis = 0; stretched && axis < 3; ++axis)
    mesh.positions.col(axis) *= 1 + 0.25 * (random() % 5);
  return mesh;
}

// A round has all shapes as they are, then all of them stretched. Of each the
// lowest pairs are found, and those about a shift.
TEST(SlicingTest, NoPairIsMissedOrDoubled) {
  const std::vector<NamedMesh> shapes = SymmetricShapes();
  const int solves = NumSolves(), count = static_cast<int>(shapes.size());
  for (int i = 0; i < solves && !HasFatalFailure(); i += 2) {
    const NamedMesh& shape = shapes[i / 2 % count];
    SCOPED_TRACE(shape.name + ", solve " + std::to_string(i));
    std::mt19937 random(i);
    const Problem problem(ShapeOf(shape.mesh, i / 2 / count % 2 == 1, random));
    ASSERT_GT(problem.n(), 500);
    const int most = std::min(501, problem.n() / 2);
    const int pairs = 20 + static_cast<int>(random() % (most - 19));
    ExpectTheLowest(problem, pairs);
    ExpectThoseAbout(problem, pairs, random);
  }
}

// Of one eigenvalue 33, of which a block has directions for 8; and very many
// below which there is a shift.
TEST(SlicingTest, EigenvaluesThatAreThereVeryOften) {
  ExpectTheLowest(Problem(Grid(24, 24)), 286);
  ExpectTheLowest(Problem(CubesSurface({{0, 0, 0}}, 10)), 288);
}

TEST(SlicingTest, FiveHundredPairs) {
  ExpectTheLowest(Problem(Torus(2, 0.8, 48, 24)), 501);
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
