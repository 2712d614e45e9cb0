// The factor against Eigen's, and its inertia against all eigenvalues.
#include "core/spectrum/supernodal_factor.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>
#include <random>

#include "core/operators/laplacian.h"
#include "core/spectrum/shift_grid.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using Block = Eigen::Matrix<double, Eigen::Dynamic, kBlock, Eigen::RowMajor>;
using Sparse = Eigen::SparseMatrix<double>;

Sparse SymmetricForm(const TriangleMesh& mesh) {
  const Laplacian laplacian = *BuildLaplacian(mesh);
  const Eigen::VectorXd scale = laplacian.M.cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * laplacian.L * scale.asDiagonal();
}

SupernodalStructure Analyse(const Sparse& A, const TriangleMesh& mesh) {
  const CancelToken cancel;
  return *AnalyseStructure(A, mesh.positions.data(), size_t{1} << 30, 2,
                           cancel);
}

std::vector<NamedMesh> Shapes() {
  return {{"cross", LimbCross(3)},
          {"torus", Torus(2, 0.8, 36, 18)},
          {"book", Book(10, 60)},
          {"needles", WithSlivers(Icosphere(3), 4, 1e-3)},
          {"two", Apart(Icosphere(2), Icosphere(3))},
          {"triangle", SingleTriangle()}};
}

// X in the structure's order.
Block Reordered(const SupernodalStructure& structure, const Block& X) {
  Block out(X.rows(), kBlock);
  for (int i = 0; i < structure.n; ++i) out.row(i) = X.row(structure.order[i]);
  return out;
}

Block Solved(const SupernodalFactor& factor, Block X, int threads) {
  Team team(threads);
  EXPECT_TRUE(factor.Solve(X.data(), team, CancelToken()).ok());
  return X;
}

// Below, between and above the eigenvalues.
TEST(SupernodalFactorTest, SolvesAsEigenDoes) {
  for (const auto& [name, mesh] : Shapes()) {
    SCOPED_TRACE(name);
    const Sparse A = SymmetricForm(mesh);
    const SupernodalStructure structure = Analyse(A, mesh);
    SupernodalFactor factor(structure);
    Team team(2);
    const Block B = Block::Random(A.rows(), kBlock);
    for (double shift : {-1.0, 33.3, 777.7, 1e7}) {
      ASSERT_TRUE(factor.Compute(shift, team, CancelToken()).ok());
      EXPECT_EQ(factor.shift(), shift);
      Sparse shifted = A;
      shifted.diagonal().array() -= shift;
      const Eigen::SimplicialLDLT<Sparse> reference(shifted);
      const Block X = reference.solve(Eigen::MatrixXd(B));
      const Block found = Solved(factor, Reordered(structure, B), 2);
      const double error = (found - Reordered(structure, X)).norm() / X.norm();
      EXPECT_LT(error, 1e-8) << shift;
      EXPECT_EQ(factor.negative_pivots(),
                (reference.vectorD().array() < 0).count());
    }
  }
}

TEST(SupernodalFactorTest, CountsTheEigenvaluesBelowAnyShift) {
  std::mt19937 random(3);
  for (const auto& [name, mesh] : Shapes()) {
    SCOPED_TRACE(name);
    const Sparse A = SymmetricForm(mesh);
    const Eigen::VectorXd exact =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(A),
                                                       Eigen::EigenvaluesOnly)
            .eigenvalues();
    const SupernodalStructure structure = Analyse(A, mesh);
    SupernodalFactor factor(structure);
    Team team(1);
    const auto expect_count_at = [&](double shift) {
      ASSERT_TRUE(FactoriseNear(shift, factor, team, CancelToken()).ok());
      EXPECT_EQ(factor.negative_pivots(),
                (exact.array() < factor.shift()).count())
          << shift;
    };
    for (int i = 0; i < 40; ++i) {
      const double near = exact[1 + random() % (exact.size() - 1)];
      expect_count_at(near * (1.0005 + 1e-3 * (random() % 1000)));
      // As near as a certificate goes, on either side.
      expect_count_at(near * (1 + 1e-6));
      expect_count_at(near * (1 - 1e-6));
    }
  }
}

// Solutions near an eigenvalue are its vectors, and huge.
TEST(SupernodalFactorTest, NearAnEigenvalueSolutionsAreItsVectors) {
  const TriangleMesh mesh = LimbCross(2);
  const Sparse A = SymmetricForm(mesh);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> exact{
      Eigen::MatrixXd(A)};
  const SupernodalStructure structure = Analyse(A, mesh);
  SupernodalFactor factor(structure);
  Team team(1);
  for (int k : {1, 7, 40}) {
    const double lambda = exact.eigenvalues()[k];
    ASSERT_TRUE(factor.Compute(lambda * (1 + 1e-9), team, CancelToken()).ok());
    Block X = Solved(factor, Block::Random(A.rows(), kBlock), 1);
    X.colwise().normalize();
    const Block vector =
        Reordered(structure, exact.eigenvectors().col(k).replicate(1, kBlock));
    EXPECT_GT(X.cwiseProduct(vector).colwise().sum().cwiseAbs().minCoeff(),
              1 - 1e-6)
        << k;
  }
}

TEST(SupernodalFactorTest, AShiftThatIsAnEigenvalueIsRefused) {
  Sparse A(12, 12);
  for (int i = 0; i < 12; ++i) A.insert(i, i) = i;
  const TriangleMesh places = Grid(3, 2);
  const SupernodalStructure structure = Analyse(A, places);
  SupernodalFactor factor(structure);
  Team team(1);
  EXPECT_EQ(factor.Compute(3, team, CancelToken()).code(),
            absl::StatusCode::kFailedPrecondition);
  ASSERT_TRUE(FactoriseNear(3, factor, team, CancelToken()).ok());
  EXPECT_EQ(factor.negative_pivots(), 4);
  EXPECT_LT(factor.shift(), 3 + 1e-5);
}

TEST(SupernodalFactorTest, ProductsAreEigens) {
  for (const auto& [name, mesh] : Shapes()) {
    const Sparse A = SymmetricForm(mesh);
    const SupernodalStructure structure = Analyse(A, mesh);
    const Block X = Block::Random(A.rows(), kBlock);
    Block Y = Reordered(structure, X);
    const Block ordered = Y;
    structure.SubtractProduct(ordered.data(), Y.data());
    const Block exact = Reordered(structure, X - A * X);
    EXPECT_LT((Y - exact).norm(), 1e-12 * exact.norm()) << name;
  }
}

// A square of so many vertices that the structure has branches. Its eigenvalues
// are pi^2 (i^2 + j^2).
TEST(SupernodalFactorTest, BranchesOfALargeMatrix) {
  const TriangleMesh mesh = Grid(560, 560);
  const Sparse A = SymmetricForm(mesh);
  const SupernodalStructure structure = Analyse(A, mesh);
  ASSERT_GT(structure.branches.size(), 1u);
  constexpr double kShift = 500;
  int below = 0;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      below += std::numbers::pi * std::numbers::pi * (i * i + j * j) < kShift;
  SupernodalFactor factor(structure), other(structure);
  Team one(1), two(2);
  ASSERT_TRUE(factor.Compute(kShift, two, CancelToken()).ok());
  EXPECT_EQ(factor.negative_pivots(), below);
  ASSERT_TRUE(other.Compute(kShift, one, CancelToken()).ok());

  const Block B = Block::Random(A.rows(), kBlock);
  const Block X = Solved(factor, B, 2);
  EXPECT_EQ(Solved(other, B, 1), X);
  // B - (A - shift) X.
  Block rest = B + kShift * X;
  structure.SubtractProduct(X.data(), rest.data());
  EXPECT_LT(rest.norm(), 1e-8 * B.norm());
}

}  // namespace
}  // namespace marrow
