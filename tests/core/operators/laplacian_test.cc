#include "core/operators/laplacian.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/operators/bridges.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

Laplacian Build(const TriangleMesh& mesh) {
  auto laplacian = BuildLaplacian(mesh);
  EXPECT_TRUE(laplacian.ok()) << laplacian.status();
  return laplacian.ok() ? *std::move(laplacian) : Laplacian();
}

double MaxDiagonal(const Laplacian& laplacian) {
  return laplacian.L.diagonal().maxCoeff();
}

class LaplacianOfAnyShape : public ::testing::TestWithParam<NamedMesh> {
 protected:
  const TriangleMesh& mesh() const { return GetParam().mesh; }
};

TEST_P(LaplacianOfAnyShape, IsSymmetricToTheLastBit) {
  const Laplacian laplacian = Build(mesh());
  const Eigen::MatrixXd L = laplacian.L;
  EXPECT_TRUE(L.allFinite());
  EXPECT_TRUE((L.array() == L.transpose().array()).all());
}

TEST_P(LaplacianOfAnyShape, SumsToZeroInEveryRow) {
  const Laplacian laplacian = Build(mesh());
  const Eigen::VectorXd sums =
      laplacian.L * Eigen::VectorXd::Ones(mesh().NumVertices());
  EXPECT_LE(sums.cwiseAbs().maxCoeff(), 1e-12 * MaxDiagonal(laplacian));
}

TEST_P(LaplacianOfAnyShape, HasTheConstantsAloneInItsKernel) {
  const Laplacian laplacian = Build(mesh());
  const Eigen::VectorXd inverse_sqrt = laplacian.M.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd symmetric = inverse_sqrt.asDiagonal() *
                                    Eigen::MatrixXd(laplacian.L) *
                                    inverse_sqrt.asDiagonal();
  const Eigen::VectorXd lambda = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                     symmetric, Eigen::EigenvaluesOnly)
                                     .eigenvalues();
  const double rounding = 1e-13 * lambda[lambda.size() - 1];
  EXPECT_NEAR(lambda[0], 0, rounding);
  EXPECT_GT(lambda[1], 0.1);
}

TEST_P(LaplacianOfAnyShape, HasPositiveMassesThatSumToOne) {
  const Laplacian laplacian = Build(mesh());
  EXPECT_GT(laplacian.M.minCoeff(), 0);
  EXPECT_NEAR(laplacian.M.sum(), 1, 1e-12);
}

TEST_P(LaplacianOfAnyShape, DoesNotDependOnTheScale) {
  const Laplacian unit = Build(mesh());
  const std::vector<double> unit_areas = FaceAreaShares(mesh());
  for (double factor : {1e-20, 1e-7, 3.0, 1e9, 1e20}) {
    const TriangleMesh scaled = Scaled(mesh(), factor);
    const Laplacian other = Build(scaled);
    // Needles magnify the rounding of coordinates.
    EXPECT_LE((unit.L - other.L).norm(), 1e-9 * unit.L.norm()) << factor;
    EXPECT_LE((unit.M - other.M).norm(), 1e-9 * unit.M.norm()) << factor;
    const std::vector<double> areas = FaceAreaShares(scaled);
    for (size_t f = 0; f < areas.size(); ++f)
      EXPECT_NEAR(areas[f], unit_areas[f], 1e-9) << factor;
  }
}

TEST_P(LaplacianOfAnyShape, HasAreaSharesThatSumToOne) {
  const std::vector<double> areas = FaceAreaShares(mesh());
  ASSERT_EQ(areas.size(), mesh().NumFaces());
  for (double area : areas) EXPECT_GE(area, 0);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 1, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Shapes, LaplacianOfAnyShape,
                         ::testing::ValuesIn(AllShapes()),
                         [](const auto& info) {
                           return TestNameOf(info.param);
                         });

TEST(LaplacianTest, HasCotangentWeights) {
  // Two right isosceles triangles: the legs weigh cot 45 / 2, the diagonal
  // between right angles nothing.
  const Laplacian laplacian = Build(Grid(1, 1));
  EXPECT_EQ(laplacian.report.mollification, 0);
  EXPECT_NEAR(laplacian.L.coeff(0, 1), -0.5, 1e-14);
  EXPECT_NEAR(laplacian.L.coeff(0, 2), -0.5, 1e-14);
  EXPECT_NEAR(laplacian.L.coeff(0, 3), 0, 1e-14);
  EXPECT_NEAR(laplacian.L.coeff(0, 0), 1, 1e-14);
  EXPECT_NEAR(laplacian.M[0], 1.0 / 3, 1e-14);
  EXPECT_NEAR(laplacian.M[1], 1.0 / 6, 1e-14);
}

// Cotangents from positions, a face at a time.
Eigen::MatrixXd CotangentLaplacian(const TriangleMesh& mesh) {
  Eigen::MatrixXd L =
      Eigen::MatrixXd::Zero(mesh.NumVertices(), mesh.NumVertices());
  for (const Triangle& face : mesh.faces) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t a = face[i], b = face[(i + 1) % 3], c = face[(i + 2) % 3];
      const Eigen::Vector3d u = mesh.Position(a) - mesh.Position(c);
      const Eigen::Vector3d v = mesh.Position(b) - mesh.Position(c);
      const double weight = 0.5 * u.dot(v) / u.cross(v).norm();
      L(a, b) -= weight;
      L(b, a) -= weight;
      L(a, a) += weight;
      L(b, b) += weight;
    }
  }
  return L;
}

TEST(LaplacianTest, IsTheCotangentLaplacianOfGoodMeshes) {
  for (const TriangleMesh& mesh : {Icosphere(3), Disk(9), Grid(12, 7)}) {
    const Laplacian laplacian = Build(mesh);
    EXPECT_EQ(laplacian.report.path, LaplacianPath::kPlain);
    EXPECT_EQ(laplacian.report.flips, 0u);
    const Eigen::MatrixXd expected = CotangentLaplacian(mesh);
    EXPECT_LE((Eigen::MatrixXd(laplacian.L) - expected).cwiseAbs().maxCoeff(),
              1e-13 * expected.diagonal().maxCoeff());
  }
}

TEST(LaplacianTest, FacesAtAnEdgeOfManyAllCount) {
  const Laplacian two = Build(Book(2, 1));
  const Laplacian six = Build(Book(6, 1));
  EXPECT_NEAR(six.L.coeff(0, 1), 3 * two.L.coeff(0, 1), 1e-12);
}

TEST(LaplacianTest, MollifiesOnlyWhereItMust) {
  EXPECT_EQ(Build(Icosphere(3)).report.mollification, 0);
  const Laplacian needles = Build(WithSlivers(Icosphere(3), 4, 1e-12));
  EXPECT_GT(needles.report.mollification, 0);
  EXPECT_LT(needles.report.mollification, 2e-5);
  const Laplacian flat = Build(WithSlivers(Grid(4, 4), 3, 0));
  EXPECT_GT(flat.report.mollification, 0);
  EXPECT_LT(flat.report.mollification, 2e-5);
}

TEST(LaplacianTest, AreaSharesAreExactForNeedles) {
  // A triangle on a line has no area, whatever was added to its edges for L.
  const TriangleMesh mesh = WithSlivers(Grid(4, 4), 2, 0);
  const std::vector<double> areas = FaceAreaShares(mesh);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const Eigen::Vector3d a = mesh.Position(mesh.faces[f][0]);
    const Eigen::Vector3d u = mesh.Position(mesh.faces[f][1]) - a;
    const Eigen::Vector3d v = mesh.Position(mesh.faces[f][2]) - a;
    const double area = 0.5 * std::abs(u.x() * v.y() - u.y() * v.x());
    // Heron's formula has half the digits where the area vanishes.
    EXPECT_NEAR(areas[f], area / 16, 1e-8);
  }
}

}  // namespace
}  // namespace marrow
