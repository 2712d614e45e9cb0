#include "core/diffusion/slowest_mode.h"

#include <memory>

#include "core/operators/bridges.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/solver.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// A ball of radius 1, and beside it a rod that is `length` times as long.
TriangleMesh BallAndRod(double length) {
  TriangleMesh rod = Icosphere(3);
  rod.positions.col(0) *= 0.05;
  rod.positions.col(1) *= length;
  rod.positions.col(2) *= 0.05;
  rod.positions.col(0).array() += 1.06;
  return Together({Icosphere(3), rod});
}

struct Solved {
  explicit Solved(const TriangleMesh& shape, uint32_t count = 60)
      : mesh(CanonicalOf(shape)),
        slowest(mesh.mesh, FaceAreaShares(mesh.mesh), FindBridges(mesh.mesh)),
        pairs(SolverEigenPairSource()
                  .Get(mesh, count, CancelToken(), nullptr)
                  .value()) {}

  const CanonicalMesh mesh;
  const SlowestMode slowest;
  const std::shared_ptr<const EigenPairs> pairs;
};

TEST(SlowestModeTest, OneShellGoesByItsFirstMode) {
  const Solved ball(Icosphere(3));
  EXPECT_TRUE(ball.slowest.IsKnownFrom(FirstPairs(*ball.pairs, 2)));
  EXPECT_EQ(ball.slowest.Of(*ball.pairs), ball.pairs->eigenvalues[1]);
}

// The first eigenvalue of a sphere is 2 / r^2, and 2 A where areas are shares.
TEST(SlowestModeTest, ALargeShellGoesByItsOwnFirstMode) {
  for (double length : {4.0, 8.0}) {
    const Solved both(BallAndRod(length));
    const double sphere = 2 * both.mesh.report.area;
    EXPECT_LT(both.pairs->eigenvalues[1], 0.5 * sphere) << length;
    EXPECT_NEAR(both.slowest.Of(*both.pairs), sphere, 0.1 * sphere);
  }
}

// What is at hand beyond those that it takes does not matter.
TEST(SlowestModeTest, MorePairsCannotMatter) {
  const TriangleMesh mesh = BallAndRod(8);
  const Solved few(mesh, SlowestMode::kPairs + 1);
  const Solved many(mesh, 100);
  EXPECT_EQ(few.slowest.Of(*few.pairs), many.slowest.Of(*many.pairs));
}

// Of equal small shells none is the body.
TEST(SlowestModeTest, SmallShellsGoByTheWhole) {
  TriangleMesh row;
  row.positions.resize(0, 3);
  for (int i = 0; i < 4; ++i) {
    TriangleMesh ball = Icosphere(2);
    ball.positions.col(0).array() += 2 * i;
    row = Together({row, ball});
  }
  const Solved balls(row);
  EXPECT_TRUE(balls.slowest.IsKnownFrom(FirstPairs(*balls.pairs, 2)));
  EXPECT_EQ(balls.slowest.Of(*balls.pairs), balls.pairs->eigenvalues[1]);
}

// A ball with one vertex pulled out as far as it is wide, and one with two.
TEST(SlowestModeTest, SpikesDoNotCount) {
  TriangleMesh ball = Icosphere(4);
  const double sphere = 2 * CanonicalOf(ball).report.area;
  for (uint32_t spikes : {1, 2}) {
    ball.positions.row(100 * spikes) *= 6;
    const Solved spiky(ball);
    EXPECT_LT(spiky.pairs->eigenvalues[spikes], 0.3 * sphere);
    EXPECT_NEAR(spiky.slowest.Of(*spiky.pairs), sphere, 0.2 * sphere);
    EXPECT_FALSE(
        spiky.slowest.IsKnownFrom(FirstPairs(*spiky.pairs, 1 + spikes)));
    const Solved fewer(ball, 1 + spikes);
    EXPECT_EQ(fewer.slowest.Of(*fewer.pairs), spiky.slowest.Of(*spiky.pairs));
  }
}

}  // namespace
}  // namespace marrow
