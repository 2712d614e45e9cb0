#include "core/pieces/map_sketch.h"

#include <Eigen/Core>
#include <algorithm>
#include <random>
#include <utility>

#include "gtest/gtest.h"

namespace marrow {
namespace {

using Row = Eigen::Map<const Eigen::Matrix<double, 1, MapSketch::kDimensions>>;

double SketchDistance(const MapSketch& sketch, uint32_t a, uint32_t b) {
  return (Row(sketch.Row(a)) - Row(sketch.Row(b))).squaredNorm();
}

// Rows that differ in `rank` directions only, none of them an axis.
DiffusionMap MapOfRank(uint32_t rows, int columns, int rank) {
  std::mt19937 random(3);
  auto fill = [&](DiffusionMap matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i)
      matrix.data()[i] = random() * 0x1p-32 - 0.5;
    return matrix;
  };
  const DiffusionMap inner = fill(DiffusionMap(rows, rank));
  DiffusionMap Phi = inner * fill(DiffusionMap(rank, columns));
  Phi.rowwise() += fill(DiffusionMap(1, columns)).row(0);
  return Phi;
}

TEST(MapSketchTest, NeverSeesMoreThanTheDistance) {
  for (int columns : {1, 15, 16, 17, 80}) {
    const DiffusionMap Phi = MapOfRank(900, columns, columns);
    const MapSketch sketch(Phi);
    for (uint32_t a = 0; a < 900; a += 7)
      for (uint32_t b = 0; b < 900; ++b)
        ASSERT_LE(SketchDistance(sketch, a, b),
                  DiffusionDistance(Phi, a, b) + sketch.slack())
            << columns << " columns";
  }
}

TEST(MapSketchTest, SeesAllOfTheDistanceWhereFewDirectionsMatter) {
  for (const auto& [columns, rank] :
       {std::pair(3, 3), {16, 16}, {60, 10}, {60, 16}, {200, 1}}) {
    const DiffusionMap Phi = MapOfRank(900, columns, rank);
    const MapSketch sketch(Phi);
    EXPECT_LT(sketch.slack(), 1e-9);
    for (uint32_t a = 0; a < 900; a += 7)
      for (uint32_t b = 0; b < 900; ++b)
        ASSERT_NEAR(SketchDistance(sketch, a, b), DiffusionDistance(Phi, a, b),
                    1e-10)
            << columns << " columns, rank " << rank;
  }
}

TEST(MapSketchTest, TakesAMapOfOneRowAndOneOfEqualRows) {
  for (uint32_t rows : {1u, 40u}) {
    const DiffusionMap Phi = DiffusionMap::Ones(rows, 30);
    EXPECT_EQ(SketchDistance(MapSketch(Phi), 0, rows - 1), 0);
  }
}

}  // namespace
}  // namespace marrow
