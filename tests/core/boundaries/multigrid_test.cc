#include "core/boundaries/multigrid.h"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>
#include <random>

#include "core/operators/laplacian.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

Eigen::VectorXd RandomVector(Eigen::Index size) {
  std::mt19937 random(31);
  Eigen::VectorXd x(size);
  for (double& value : x) value = random() * 0x1p-32 - 0.5;
  return x;
}

// Many triangles around one vertex.
TriangleMesh Fan(uint32_t around) {
  TriangleMesh mesh;
  mesh.positions.setZero(around + 1, 3);
  for (uint32_t i = 1; i <= around; ++i) {
    const double angle = 2 * std::numbers::pi * i / around;
    mesh.positions.row(i) << std::cos(angle), std::sin(angle), 0.1;
    mesh.faces.push_back({0, i, i % around + 1});
  }
  return mesh;
}

double RelativeError(const Eigen::VectorXd& x, const Eigen::VectorXd& exact) {
  return (x - exact).norm() / exact.norm();
}

TEST(MultigridTest, AgreesWithADirectSolver) {
  for (const auto& [name, mesh] : AllShapes()) {
    const Laplacian laplacian = BuildLaplacian(mesh).value();
    Multigrid grid(laplacian);
    const Eigen::VectorXd b =
        laplacian.M.cwiseProduct(RandomVector(laplacian.M.size()));
    for (double c : {0.0, 1e-6, 1e-3, 1.0}) {
      Eigen::SparseMatrix<double> A = c * laplacian.L;
      A.diagonal() += laplacian.M;
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> direct(A);
      Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
      grid.SetStep(c);
      EXPECT_LT(grid.Solve(b, 1e-12, CancelToken(), x), 60) << name;
      EXPECT_LT(RelativeError(x, direct.solve(b)), 1e-8) << name << ", " << c;
    }
  }
}

// Steps that conjugate gradients alone would take the more of, the finer the
// mesh is.
TEST(MultigridTest, TakesAsFewStepsOnFineMeshes) {
  for (const TriangleMesh& mesh :
       {Grid(40, 40), Grid(320, 320), Fan(100'000), Icosphere(6)}) {
    const Laplacian laplacian = BuildLaplacian(mesh).value();
    Multigrid grid(laplacian);
    grid.SetStep(0.02);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(laplacian.M.size());
    const Eigen::VectorXd b = laplacian.M.cwiseProduct(RandomVector(x.size()));
    EXPECT_LT(grid.Solve(b, 1e-6, CancelToken(), x), 25)
        << mesh.NumVertices() << " vertices";
  }
}

TEST(MultigridTest, StopsOnceCancelled) {
  const Laplacian laplacian = BuildLaplacian(Grid(30, 30)).value();
  Multigrid grid(laplacian);
  grid.SetStep(0.1);
  CancelToken cancel;
  cancel.Cancel();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(laplacian.M.size());
  EXPECT_EQ(grid.Solve(laplacian.M, 1e-6, cancel, x), 0);
}

}  // namespace
}  // namespace marrow
