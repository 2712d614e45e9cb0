#include "core/mesh/place_factors.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

constexpr double kSpread = 0.3;

// Without a symmetry, of equal squares.
TriangleMesh Hook() {
  return CubesSurface({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 0, 1}},
                      10);
}

TEST(PlaceFactorsTest, AreThoseOfTheMeshMovedTurnedMirroredAndScaled) {
  const TriangleMesh mesh = Hook();
  TriangleMesh other =
      Rotated(Scaled(mesh, 1e-3), Eigen::Vector3d(1, 2, -0.7), 1.2);
  other.positions.col(1) *= -1;
  other.positions.rowwise() += Eigen::RowVector3d(0.01, 0, -0.02);
  const Renumbering renumbered = Renumber(other, 1);
  const std::vector<double> factors = PlaceFactors(mesh, kSpread);
  const std::vector<double> found = PlaceFactors(renumbered.mesh, kSpread);
  ASSERT_EQ(found.size(), factors.size());
  for (uint32_t v = 0; v < found.size(); ++v)
    EXPECT_NEAR(found[v], factors[renumbered.old_vertex[v]], 1e-9);
}

TEST(PlaceFactorsTest, NeitherOverflowNorVanish) {
  const TriangleMesh mesh = Hook();
  const std::vector<double> factors = PlaceFactors(mesh, kSpread);
  for (double scale : {0x1p-400, 0x1p400})
    EXPECT_EQ(PlaceFactors(Scaled(mesh, scale), kSpread), factors);
}

TEST(PlaceFactorsTest, TellNeighboursApart) {
  const TriangleMesh mesh = Hook();
  const std::vector<double> factors = PlaceFactors(mesh, kSpread);
  uint32_t close = 0;
  for (const Triangle& face : mesh.faces)
    close += std::abs(std::log(factors[face[0]] / factors[face[1]])) < 1e-3;
  EXPECT_LE(close, mesh.NumFaces() / 50);
}

TEST(PlaceFactorsTest, StayWithinTheSpread) {
  for (const NamedMesh& shape : AllShapes()) {
    SCOPED_TRACE(shape.name);
    for (double factor : PlaceFactors(shape.mesh, kSpread)) {
      EXPECT_GE(factor, 1 / (1 + kSpread) - 1e-12);
      EXPECT_LE(factor, 1 + kSpread + 1e-12);
    }
  }
}

TEST(PlaceFactorsTest, AreOneWhereThereIsNoArea) {
  TriangleMesh line = SingleTriangle();
  line.positions.setZero();
  EXPECT_EQ(PlaceFactors(line, kSpread), std::vector<double>(3, 1));
}

}  // namespace
}  // namespace marrow
