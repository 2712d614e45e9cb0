#include "client/polygon_mesh.h"

#include <gtest/gtest.h>

#include <limits>

namespace marrow {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(IsFloatTest, TellsWhatAFloatHolds) {
  for (const double x : {0.0, -1.5, double{0.1f}, double{kLargest},
                         double{std::numeric_limits<float>::denorm_min()},
                         std::numeric_limits<double>::quiet_NaN(),
                         -std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(IsFloat(x)) << x;
  }
  for (const double x : {0.1, 16777217.0, 1e39, -1e300, 1e-50}) {
    EXPECT_FALSE(IsFloat(x)) << x;
  }
}

TEST(AreFloatsTest, OneDoubleIsEnough) {
  EXPECT_TRUE(AreFloats({}));
  EXPECT_TRUE(AreFloats({{1, 2, 3}, {0.5, 0.25, 0.125}}));
  EXPECT_FALSE(AreFloats({{1, 2, 3}, {0.5, 0.25, 0.1}}));
}

TEST(ToFloatTest, RoundsToInfinityWhereThatIsNearest) {
  EXPECT_EQ(ToFloat(0.1), 0.1f);
  EXPECT_EQ(ToFloat(kLargest * (1 + 1e-9)), kLargest);
  EXPECT_EQ(ToFloat(kLargest * (1 + 1e-7)), kInfinity);
  EXPECT_EQ(ToFloat(-1e300), -kInfinity);
}

[[gnu::noinline]] void Append(double x, double y, double z, PolygonMesh& mesh) {
  mesh.positions.push_back(
      {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
}

// Some compilers forget to.
TEST(PolygonMeshTest, FloatsAreRoundedOnTheirWayIntoIt) {
  PolygonMesh mesh;
  Append(0.1, 0.2, 0.3, mesh);
  EXPECT_TRUE(AreFloats(mesh.positions));
}

}  // namespace
}  // namespace marrow
