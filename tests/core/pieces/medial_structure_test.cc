#include "core/pieces/medial_structure.h"

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "core/operators/laplacian.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

DiffusionMap RandomMap(uint32_t rows, int columns, std::mt19937& random) {
  DiffusionMap Phi(rows, columns);
  for (Eigen::Index i = 0; i < Phi.size(); ++i)
    Phi.data()[i] = random() * 0x1p-32 - 0.5;
  return Phi;
}

std::vector<uint32_t> RandomStructure(uint32_t n, uint32_t size,
                                      std::mt19937& random) {
  std::set<uint32_t> chosen;
  while (chosen.size() < size) chosen.insert(random() % n);
  return {chosen.begin(), chosen.end()};
}

double BruteForce(const DiffusionMap& Phi,
                  const std::vector<uint32_t>& structure, uint32_t v) {
  double least = DiffusionDistance(Phi, v, structure.front());
  for (uint32_t u : structure)
    least = std::min(least, DiffusionDistance(Phi, v, u));
  return least;
}

// Dimensions on both sides of where a sketch is less than the map.
TEST(StructureDistanceTest, IsTheLeastDistance) {
  std::mt19937 random(11);
  for (int columns : {1, 2, 6, 16, 17, 60}) {
    const DiffusionMap Phi = RandomMap(400, columns, random);
    const MapSketch sketch(Phi);
    for (uint32_t size : {1u, 2u, 47u, 48u, 300u, 400u}) {
      const auto structure = RandomStructure(400, size, random);
      const StructureDistance distance(sketch, structure);
      for (uint32_t v = 0; v < 400; ++v) {
        const double exact = BruteForce(Phi, structure, v);
        ASSERT_NEAR(distance(v), exact, 1e-14 * columns)
            << columns << " columns, " << size << " points";
      }
    }
  }
}

TEST(StructureDistanceTest, IsTheSameWhereverTheSearchBegins) {
  std::mt19937 random(15);
  for (int columns : {2, 16, 17}) {
    const DiffusionMap Phi = RandomMap(200, columns, random);
    const MapSketch sketch(Phi);
    const auto structure = RandomStructure(200, 100, random);
    const StructureDistance distance(sketch, structure);
    for (uint32_t v = 0; v < 200; ++v)
      for (uint32_t begin : {0u, 50u, 99u}) {
        uint32_t point = begin;
        ASSERT_EQ(distance.From(point, v), distance(v)) << columns;
        ASSERT_NEAR(DiffusionDistance(Phi, structure[point], v), distance(v),
                    1e-14 * columns);
      }
  }
}

TEST(StructureDistanceTest, GivesUpWhereNothingIsNearerThanTheBound) {
  std::mt19937 random(16);
  const DiffusionMap Phi = RandomMap(200, 20, random);
  const MapSketch sketch(Phi);
  const StructureDistance distance(sketch, RandomStructure(200, 30, random));
  for (uint32_t v = 0; v < 200; ++v) {
    const double exact = distance(v);
    for (double bound : {0.5 * exact, exact, 1.01 * exact + 0.01}) {
      uint32_t point = 7;
      ASSERT_EQ(distance.From(point, v, bound), std::min(bound, exact));
    }
  }
}

TEST(StructureDistanceTest, MayBeMoved) {
  std::mt19937 random(12);
  const DiffusionMap Phi = RandomMap(200, 3, random);
  const MapSketch sketch(Phi);
  const auto structure = RandomStructure(200, 100, random);
  auto original = std::make_unique<StructureDistance>(sketch, structure);
  const StructureDistance moved = std::move(*original);
  original.reset();
  for (uint32_t v = 0; v < 200; ++v)
    EXPECT_NEAR(moved(v), BruteForce(Phi, structure, v), 1e-14);
}

TEST(StructureDistanceTest, TakesManyEqualPoints) {
  const DiffusionMap Phi = DiffusionMap::Ones(5000, 2);
  std::vector<uint32_t> all(5000);
  for (uint32_t v = 0; v < 5000; ++v) all[v] = v;
  EXPECT_EQ(StructureDistance(MapSketch(Phi), all)(77), 0);
}

struct Scene {
  TriangleMesh mesh = LimbCross(1);
  std::vector<double> areas = FaceAreaShares(mesh);
  std::vector<uint32_t> faces;
  DiffusionMap Phi;

  Scene() {
    for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
      if (f % 5 != 0) faces.push_back(f);
  }
  Region MakeRegion() {
    const Region region(mesh, Adjacency(mesh), areas, faces);
    std::mt19937 random(13);
    Phi = RandomMap(region.NumVertices(), 4, random);
    return region;
  }
};

// The mean of the squared distance to the faces by the rule of the edges'
// middles, which is exact.
double NaiveAdd(const Region& region, const DiffusionMap& Phi,
                const std::vector<uint32_t>& members,
                const Eigen::RowVectorXd& point) {
  double sum = 0, area = 0;
  for (uint32_t f : members) {
    const Triangle& corner = region.triangles()[f];
    for (int i = 0; i < 3; ++i)
      sum += region.areas()[f] / 3 *
             (point - 0.5 * (Phi.row(corner[i]) + Phi.row(corner[(i + 1) % 3])))
                 .squaredNorm();
    area += region.areas()[f];
  }
  return sum / area;
}

std::vector<uint32_t> NaiveStructure(const Region& region,
                                     const DiffusionMap& Phi,
                                     const std::vector<uint32_t>& members,
                                     double epsilon) {
  std::set<uint32_t> corners;
  double mean = 0, area = 0;
  for (uint32_t f : members) {
    const Triangle& corner = region.triangles()[f];
    corners.insert(corner.begin(), corner.end());
    for (int i = 0; i < 3; ++i)
      mean +=
          region.areas()[f] / 3 *
          NaiveAdd(region, Phi, members,
                   0.5 * (Phi.row(corner[i]) + Phi.row(corner[(i + 1) % 3])));
    area += region.areas()[f];
  }
  mean /= area;
  std::vector<std::pair<double, uint32_t>> add;
  for (uint32_t v : corners)
    add.push_back({NaiveAdd(region, Phi, members, Phi.row(v)), v});
  const double least = std::min_element(add.begin(), add.end())->first;
  std::vector<uint32_t> structure;
  for (const auto& [value, v] : add)
    if (value <= least + epsilon * mean) structure.push_back(v);
  return structure;
}

TEST(ComputeMedialStructureTest, AgreesWithTheDefinition) {
  Scene scene;
  const Region region = scene.MakeRegion();
  std::vector<uint32_t> members;
  for (uint32_t f = 1; f < region.NumFaces(); f += 3) members.push_back(f);
  size_t before = 0;
  for (double epsilon : {0.0, 0.1, 0.3, 1.0, 10.0}) {
    const auto structure =
        ComputeMedialStructure(region, scene.Phi, members, epsilon);
    EXPECT_THAT(structure, ::testing::ElementsAreArray(NaiveStructure(
                               region, scene.Phi, members, epsilon)))
        << epsilon;
    EXPECT_GE(structure.size(), std::max<size_t>(1, before));
    before = structure.size();
  }
}

TEST(ComputeMedialStructureTest, TakesAllOfASegmentWithoutArea) {
  const TriangleMesh mesh = Grid(1, 1);
  const Region region(mesh, Adjacency(mesh), {0.0, 1.0}, {0, 1});
  std::mt19937 random(14);
  const DiffusionMap Phi = RandomMap(4, 2, random);
  EXPECT_THAT(ComputeMedialStructure(region, Phi, std::vector<uint32_t>{0}, 0),
              ::testing::ElementsAre(0, 2, 3));
}

}  // namespace
}  // namespace marrow
