#include "core/diffusion/diffusion_map.h"

#include <array>
#include <cmath>
#include <numeric>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/operators/laplacian.h"
#include "core/spectrum/solver.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

std::shared_ptr<const EigenPairs> Solve(const TriangleMesh& mesh,
                                        uint32_t count) {
  const CancelToken cancel;
  return SolverEigenPairSource()
      .Get(CanonicalOf(mesh), count, cancel, nullptr)
      .value();
}

EigenPairs PairsOf(std::vector<double> eigenvalues, bool complete) {
  EigenPairs pairs;
  pairs.eigenvalues =
      Eigen::Map<Eigen::VectorXd>(eigenvalues.data(), eigenvalues.size());
  pairs.eigenvectors.setRandom(4, eigenvalues.size());
  pairs.complete = complete;
  return pairs;
}

std::vector<uint32_t> Everything(size_t n) {
  std::vector<uint32_t> all(n);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

// A mesh with a map whose columns are smooth functions, not eigenvectors: the
// means must be right for any map.
struct Scene {
  TriangleMesh mesh = CanonicalOf(LimbCross(1)).mesh;
  std::vector<double> areas = FaceAreaShares(mesh);
  std::vector<uint32_t> members;
  DiffusionMap Phi;

  Scene() : Phi(mesh.NumVertices(), 5) {
    for (uint32_t f = 0; f < mesh.NumFaces(); f += 2) members.push_back(f);
    for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
      for (int k = 0; k < 5; ++k)
        Phi(v, k) = std::sin((k + 1) * mesh.positions.row(v).sum() + k * k +
                             mesh.positions(v, k % 3));
  }
  FaceSet set() const { return {mesh.faces, areas, members}; }

  // The mean over the set of a function of the (linear) map. The rule of the
  // edges' middles is exact for quadratic functions.
  template <typename Function>
  double Integrate(const Function& function) const {
    double sum = 0, area = 0;
    for (uint32_t f : members) {
      for (int i = 0; i < 3; ++i) {
        const Eigen::RowVectorXd middle =
            0.5 *
            (Phi.row(mesh.faces[f][i]) + Phi.row(mesh.faces[f][(i + 1) % 3]));
        sum += areas[f] / 3 * function(middle);
      }
      area += areas[f];
    }
    return sum / area;
  }
};

TEST(TimeScaleTest, IsEquationTen) {
  const EigenPairs pairs = PairsOf({0, 4, 9, 16}, true);
  EXPECT_DOUBLE_EQ(TimeScale(pairs.eigenvalues[1], 1), 1.0 / 8);
  EXPECT_DOUBLE_EQ(TimeScale(pairs.eigenvalues[1], 0.25), 1.0 / 32);
}

TEST(MapDimensionTest, CountsThePairsAboveDelta) {
  const EigenPairs pairs = PairsOf({0, 1, 2, 3, 4, 50, 60}, false);
  EXPECT_EQ(MapDimension(pairs, 1, std::exp(-2.5)), 2u);
  EXPECT_EQ(MapDimension(pairs, 1, std::exp(-4.5)), 4u);
  EXPECT_EQ(MapDimension(pairs, 0.5, std::exp(-2.25)), 4u);
}

TEST(MapDimensionTest, IsAtLeastOne) {
  EXPECT_EQ(MapDimension(PairsOf({0, 10, 20, 30}, false), 1, 0.5), 1u);
}

TEST(MapDimensionTest, HasNoValueWhereMorePairsMayBeWanted) {
  const double delta = std::exp(-10);
  EXPECT_EQ(MapDimension(PairsOf({0, 1, 2, 3}, false), 1, delta), std::nullopt);
  EXPECT_EQ(MapDimension(PairsOf({0, 1, 2, 3}, true), 1, delta), 3u);
  // The last pair at hand may belong to a cluster that is cut off.
  EXPECT_EQ(MapDimension(PairsOf({0, 1, 2, 2}, false), 1, std::exp(-1.5)), 1u);
  EXPECT_EQ(MapDimension(PairsOf({0, 2, 2}, false), 1, std::exp(-1.0)),
            std::nullopt);
}

TEST(MapDimensionTest, NeverSplitsAClusterOfEqualEigenvalues) {
  // Two clusters whose members differ by rounding alone; the threshold falls
  // into the midst of each.
  const double tiny = 1e-13;
  const EigenPairs pairs =
      PairsOf({0, 1 - tiny, 1, 1 + tiny, 3 - tiny, 3, 3, 3 + tiny, 9}, false);
  for (double offset : {-0.5, 0.0, 0.5}) {
    EXPECT_EQ(MapDimension(pairs, 1, std::exp(-(1 + offset * tiny))), 3u);
    EXPECT_EQ(MapDimension(pairs, 1, std::exp(-(3 + offset * tiny))), 7u);
  }
}

TEST(NumPairsOfWholeClustersTest, LeavesOutAClusterThatMayGoOn) {
  EXPECT_EQ(NumPairsOfWholeClusters(PairsOf({0, 1, 2, 3}, false)), 3u);
  EXPECT_EQ(NumPairsOfWholeClusters(PairsOf({0, 1, 2, 2, 2}, false)), 1u);
  EXPECT_EQ(NumPairsOfWholeClusters(PairsOf({0, 1, 2, 2, 2}, true)), 4u);
  EXPECT_EQ(NumPairsOfWholeClusters(PairsOf({0, 5, 5}, false)), 0u);
  EXPECT_EQ(NumPairsOfWholeClusters(PairsOf({0}, false)), 0u);
}

TEST(MapDimensionTest, TakesTheClustersOfASphereWhole) {
  const auto pairs = Solve(Icosphere(3), 30);
  for (double t = 0.001; t < 1; t *= 1.3) {
    const auto dimension = MapDimension(*pairs, t, 0.1);
    if (!dimension) continue;
    // 3, 3 + 5, then the icosahedron splits the seven of degree 3 in 4 and 3.
    EXPECT_TRUE(*dimension == 3 || *dimension == 8 || *dimension == 11 ||
                *dimension == 12 || *dimension == 15 || *dimension >= 19)
        << t << ": " << *dimension;
  }
}

TEST(DiffusionMapTest, HasARowAVertexInTheirOrder) {
  const auto pairs = Solve(Icosphere(1), 20);
  const std::vector<uint32_t> vertices = {7, 3, 41};
  const DiffusionMap Phi = BuildDiffusionMap(*pairs, vertices, 0.3, 8);
  ASSERT_EQ(Phi.rows(), 3);
  ASSERT_EQ(Phi.cols(), 8);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 8; ++k)
      EXPECT_DOUBLE_EQ(Phi(i, k), std::exp(-0.3 * pairs->eigenvalues[k + 1]) *
                                      pairs->eigenvectors(vertices[i], k + 1));
}

// Eq. 6 by another road: the distance in terms of the heat kernel of 2 t, taken
// as a matrix exponential.
TEST(DiffusionDistanceTest, IsThatOfTheHeatKernel) {
  const CanonicalMesh canonical = CanonicalOf(LimbCross(1));
  const uint32_t n = canonical.mesh.NumVertices();
  const auto pairs = Solve(LimbCross(1), n);
  ASSERT_TRUE(pairs->complete);
  const Laplacian laplacian = *BuildLaplacian(canonical.mesh);
  const Eigen::MatrixXd inverse_mass = laplacian.M.cwiseInverse().asDiagonal();
  for (double t : {0.001, 0.02}) {
    const Eigen::MatrixXd generator =
        -2 * t * inverse_mass * Eigen::MatrixXd(laplacian.L);
    const Eigen::MatrixXd kernel = generator.exp() * inverse_mass;
    const DiffusionMap Phi = BuildDiffusionMap(*pairs, Everything(n), t, n - 1);
    for (uint32_t a = 0; a < n; a += 5)
      for (uint32_t b = 0; b < n; b += 3) {
        const double exact = kernel(a, a) + kernel(b, b) - 2 * kernel(a, b);
        // Eigenvectors are float32: seven digits.
        EXPECT_NEAR(DiffusionDistance(Phi, a, b), exact,
                    1e-6 * (kernel(a, a) + kernel(b, b)));
      }
  }
}

TEST(AverageDistanceTest, AtAVertexIsTheIntegral) {
  const Scene scene;
  const AverageDistance add(scene.Phi, scene.set());
  for (uint32_t v = 0; v < scene.mesh.NumVertices(); ++v) {
    const double exact = scene.Integrate([&](const Eigen::RowVectorXd& y) {
      return (scene.Phi.row(v) - y).squaredNorm();
    });
    EXPECT_NEAR(add.At(v), exact, 1e-12 * exact);
  }
}

TEST(AverageDistanceTest, MeanIsTheDoubleIntegral) {
  const Scene scene;
  const double exact = scene.Integrate([&](const Eigen::RowVectorXd& x) {
    return scene.Integrate(
        [&](const Eigen::RowVectorXd& y) { return (x - y).squaredNorm(); });
  });
  EXPECT_NEAR(AverageDistance(scene.Phi, scene.set()).Mean(), exact,
              1e-12 * exact);
}

TEST(MeanDistanceTest, IsTheIntegralOfTheDistanceToAPoint) {
  const Scene scene;
  for (uint32_t point : {0u, 11u, 29u}) {
    std::vector<double> distance;
    for (uint32_t v = 0; v < scene.mesh.NumVertices(); ++v)
      distance.push_back(DiffusionDistance(scene.Phi, v, point));
    const double exact = scene.Integrate([&](const Eigen::RowVectorXd& x) {
      return (x - scene.Phi.row(point)).squaredNorm();
    });
    EXPECT_NEAR(MeanDistance(scene.Phi, scene.set(), distance), exact,
                1e-12 * exact);
  }
}

// Where the medial structure has every vertex, Eq. 15 is negative: what the
// distance lacks within a triangle is all that is left of it.
TEST(MeanDistanceTest, IsNegativeWhereTheStructureHasEveryVertex) {
  const std::vector<Triangle> faces = {{0, 1, 2}};
  const std::vector<double> areas = {1};
  const std::vector<uint32_t> members = {0};
  const FaceSet set{faces, areas, members};
  DiffusionMap Phi(3, 2);
  Phi << 0, 0, 4, 0, 1, 3;
  const double squared_edges = 16 + 18 + 10;
  EXPECT_DOUBLE_EQ(MeanDistance(Phi, set, std::vector<double>(3, 0.0)),
                   -squared_edges / 12);
  EXPECT_DOUBLE_EQ(AverageDistance(Phi, set).Mean(), squared_edges / 18);
}

}  // namespace
}  // namespace marrow
