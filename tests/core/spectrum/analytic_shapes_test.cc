// Eigenvalues of surfaces whose spectrum is known. The errors must be small and
// shrink by nearly four when edges are halved (second order).
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/spectrum/solver.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using std::numbers::pi;

// Of the surface at its own size, the zero included.
Eigen::VectorXd EigenvaluesOf(const TriangleMesh& mesh, uint32_t count) {
  const CancelToken cancel;
  const auto pairs =
      SolverEigenPairSource().Get(CanonicalOf(mesh), count, cancel, nullptr);
  EXPECT_TRUE(pairs.ok()) << pairs.status();
  return (*pairs)->eigenvalues / (*pairs)->area;
}

// The greatest relative error of the eigenvalues after the zero.
double WorstError(const TriangleMesh& mesh, const std::vector<double>& exact) {
  const auto found = EigenvaluesOf(mesh, static_cast<uint32_t>(exact.size()));
  double worst = 0;
  for (size_t k = 0; k < exact.size(); ++k)
    worst = std::max(worst, std::abs(found[k + 1] / exact[k] - 1));
  return worst;
}

std::vector<double> SphereEigenvalues(int greatest_degree) {
  std::vector<double> exact;
  for (int l = 1; l <= greatest_degree; ++l)
    exact.insert(exact.end(), 2 * l + 1, l * (l + 1));
  return exact;
}

// (j'_{m,s})^2: squared zeros of the derivatives of Bessel functions, twice
// where m > 0.
std::vector<double> DiskEigenvalues() {
  std::vector<double> exact;
  for (double zero :
       {1.8411837813, 3.0542369282, 4.2011889412, 5.3175531260, 5.3314427735})
    exact.insert(exact.end(), 2, zero * zero);
  for (double zero : {3.8317059702}) exact.push_back(zero * zero);
  std::sort(exact.begin(), exact.end());
  return exact;
}

// The torus of revolution separates into u(v) e^(i m phi) with
//    -(w u')' / (r^2 w) + m^2 u / w^2 = lambda u,   w = R + r cos v,
// a periodic problem on a circle, solved here by finite volumes.
Eigen::VectorXd TorusMode(double R, double r, int m, int cells) {
  const double h = 2 * pi / cells;
  auto w = [&](double place) { return R + r * std::cos(place * h); };
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(cells, cells);
  for (int i = 0; i < cells; ++i) {
    const int next = (i + 1) % cells;
    const double flow = w(i + 0.5) / (r * r * h * h);
    A(i, i) += flow / w(i) + m * m / (w(i) * w(i));
    A(next, next) += flow / w(next);
    A(i, next) -= flow / std::sqrt(w(i) * w(next));
    A(next, i) -= flow / std::sqrt(w(i) * w(next));
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A,
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues();
}

std::vector<double> TorusEigenvalues(double R, double r, size_t count) {
  std::vector<double> exact;
  for (int m = 0; m <= 6; ++m) {
    const Eigen::VectorXd coarse = TorusMode(R, r, m, 100);
    const Eigen::VectorXd fine = TorusMode(R, r, m, 200);
    for (int k = 0; k < 10; ++k)  // Richardson: fourth order
      exact.insert(exact.end(), m == 0 ? 1 : 2, (4 * fine[k] - coarse[k]) / 3);
  }
  std::sort(exact.begin(), exact.end());
  exact.erase(exact.begin());  // the constant's zero
  exact.resize(count);
  return exact;
}

TEST(AnalyticShapesTest, Sphere) {
  const auto exact = SphereEigenvalues(4);
  const double coarse = WorstError(Icosphere(3), exact);
  const double fine = WorstError(Icosphere(4), exact);
  const double finest = WorstError(Icosphere(5), exact);
  EXPECT_LT(coarse, 0.05);
  EXPECT_LT(fine, coarse / 3);
  EXPECT_LT(finest, fine / 3);
  EXPECT_LT(finest, 0.003);  // 10,242 vertices
}

TEST(AnalyticShapesTest, Disk) {
  const auto exact = DiskEigenvalues();
  const double coarse = WorstError(Disk(13), exact);
  const double fine = WorstError(Disk(26), exact);
  EXPECT_LT(coarse, 0.03);
  EXPECT_LT(fine, coarse / 3);
}

TEST(AnalyticShapesTest, TorusOfRevolution) {
  const auto exact = TorusEigenvalues(2, 0.8, 16);
  const double coarse = WorstError(Torus(2, 0.8, 40, 16), exact);
  const double fine = WorstError(Torus(2, 0.8, 80, 32), exact);
  EXPECT_LT(coarse, 0.05);
  EXPECT_LT(fine, coarse / 3);
}

TEST(AnalyticShapesTest, Rectangle) {
  std::vector<double> exact;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 5; ++j)
      exact.push_back(pi * pi * (i * i / 900.0 + j * j / 100.0));
  std::sort(exact.begin(), exact.end());
  exact.erase(exact.begin());
  exact.resize(15);
  // The finer one is half the size, hence four times the eigenvalues.
  const double coarse = WorstError(Grid(30, 10), exact);
  const double fine = WorstError(Scaled(Grid(60, 20), 0.5), exact);
  EXPECT_LT(coarse, 0.04);
  EXPECT_LT(fine, coarse / 3);
}

TEST(AnalyticShapesTest, NeedlesLeaveTheSpectrumAlone) {
  const auto exact = SphereEigenvalues(3);
  const double clean = WorstError(Icosphere(4), exact);
  for (double height : {1e-3, 1e-6, 1e-12, 0.0})
    EXPECT_LT(WorstError(WithSlivers(Icosphere(4), 4, height), exact),
              2 * clean)
        << height;
}

TEST(AnalyticShapesTest, EigenvaluesFollowTheScale) {
  const Eigen::VectorXd unit = EigenvaluesOf(Icosphere(2), 20);
  for (double factor : {1e-20, 1e-3, 1e5, 1e20}) {
    const Eigen::VectorXd scaled =
        EigenvaluesOf(Scaled(Icosphere(2), factor), 20);
    for (int k = 1; k <= 20; ++k)
      EXPECT_NEAR(scaled[k] * factor * factor / unit[k], 1, 1e-9)
          << factor << ", pair " << k;
  }
}

TEST(AnalyticShapesTest, EigenvaluesDoNotFeelARotation) {
  const TriangleMesh mesh = LimbCross(3);
  const Eigen::VectorXd here = EigenvaluesOf(mesh, 30);
  const Eigen::VectorXd there =
      EigenvaluesOf(Rotated(mesh, {1, 2, -3}, 0.9), 30);
  for (int k = 1; k <= 30; ++k) EXPECT_NEAR(there[k] / here[k], 1, 1e-8) << k;
}

}  // namespace
}  // namespace marrow
