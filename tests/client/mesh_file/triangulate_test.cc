#include "client/mesh_file/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace marrow {
namespace {

using Points = std::vector<std::array<double, 2>>;

double SignedArea(const Points& p, uint32_t a, uint32_t b, uint32_t c) {
  return ((p[b][0] - p[a][0]) * (p[c][1] - p[a][1]) -
          (p[b][1] - p[a][1]) * (p[c][0] - p[a][0])) /
         2;
}

double SignedArea(const Points& polygon) {
  double area = 0;
  for (uint32_t i = 1; i + 1 < polygon.size(); ++i) {
    area += SignedArea(polygon, 0, i, i + 1);
  }
  return area;
}

// The polygon in one of four planes; the last is oblique.
PolygonMesh Place(const Points& polygon, int plane) {
  PolygonMesh mesh;
  for (const auto& p : polygon) {
    std::array<double, 3> point = {static_cast<double>(p[0]),
                                   static_cast<double>(p[1]), 0};
    if (plane == 3) point[2] = point[0] + 2 * point[1];
    for (int turn = 0; turn < plane % 3; ++turn) {
      point = {point[2], point[0], point[1]};
    }
    mesh.positions.push_back(point);
  }
  return mesh;
}

// No triangle is turned over, and the areas add up.
void ExpectCoveredOnce(const Points& polygon, PolygonMesh mesh, uint32_t first,
                       bool reversed) {
  const uint32_t n = static_cast<uint32_t>(polygon.size());
  std::vector<uint32_t> corners(n);
  for (uint32_t i = 0; i < n; ++i) {
    corners[i] = (reversed ? first + n - i : first + i) % n;
  }
  mesh.AddFace(corners);
  std::vector<std::array<uint32_t, 3>> triangles;
  Triangulate(mesh, 0, &triangles);
  ASSERT_EQ(triangles.size(), n - 2);
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const double part = (reversed ? -1 : 1) * SignedArea(polygon, a, b, c);
    EXPECT_GE(part, -1e-6) << first << " " << reversed;
    sum += part;
  }
  EXPECT_NEAR(sum, SignedArea(polygon), 1e-5);
}

// Begun at any corner, either way round, on any plane.
void ExpectCovered(const Points& polygon) {
  for (int plane = 0; plane < 4; ++plane) {
    const PolygonMesh mesh = Place(polygon, plane);
    for (uint32_t first = 0; first < polygon.size(); ++first) {
      ExpectCoveredOnce(polygon, mesh, first, false);
      ExpectCoveredOnce(polygon, mesh, first, true);
    }
  }
}

TEST(TriangulateTest, CoversConvexAndConcavePolygonsOnce) {
  ExpectCovered({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  ExpectCovered({{0, 0}, {4, 0}, {1, 1}, {0, 4}});                  // dart
  ExpectCovered({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}});  // L
  ExpectCovered({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}});          // on a line
}

TEST(TriangulateTest, CoversAStar) {
  Points star;
  for (int i = 0; i < 14; ++i) {
    const double radius = i % 2 == 0 ? 3 : 1;
    const double angle = i * M_PI / 7;
    star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  ExpectCovered(star);
}

// Two arms of a spiral, one from inside out and one back.
Points Spiral(int turns, int corners) {
  Points spiral;
  for (int i = 0; i < corners; ++i) {
    const bool is_back = i >= corners / 2;
    const double angle =
        2 * M_PI * turns * (is_back ? corners - 1 - i : i) / (corners / 2 - 1);
    const double radius = 1 + angle + (is_back ? 2 : 0);
    spiral.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  if (SignedArea(spiral) < 0) std::reverse(spiral.begin(), spiral.end());
  return spiral;
}

Points Comb(int teeth) {
  Points comb = {{0, 0}, {2.0 * teeth + 1, 0}};
  for (int tooth = teeth; tooth > 0; --tooth) {
    comb.push_back({2.0 * tooth, 5});
    comb.push_back({2.0 * tooth - 1, 1});
  }
  comb.push_back({0, 5});
  return comb;
}

TEST(TriangulateTest, CoversAComb) { ExpectCovered(Comb(6)); }

// In a test's time only where not every ear is compared with every corner.
TEST(TriangulateTest, CoversPolygonsOfManyCorners) {
  for (const Points& polygon :
       {Spiral(5, 1020), Spiral(10, 20000), Comb(1000), Comb(10000)}) {
    const PolygonMesh mesh = Place(polygon, 0);
    ExpectCoveredOnce(polygon, mesh, 0, false);
    ExpectCoveredOnce(polygon, mesh, 7, true);
  }
}

// Each side of the polygon is a side of exactly one triangle, the same way.
TEST(TriangulateTest, KeepsEverySideEvenOfAPolygonWithoutArea) {
  PolygonMesh mesh;
  mesh.positions.assign(6, {1, 2, 3});
  std::vector<uint32_t> corners(6);
  std::iota(corners.begin(), corners.end(), 0u);
  mesh.AddFace(corners);
  std::vector<std::array<uint32_t, 3>> triangles;
  Triangulate(mesh, 0, &triangles);
  ASSERT_EQ(triangles.size(), 4u);
  std::multiset<std::pair<uint32_t, uint32_t>> sides;
  for (const auto& t : triangles) {
    for (int i = 0; i < 3; ++i) sides.insert({t[i], t[(i + 1) % 3]});
  }
  for (uint32_t i = 0; i < 6; ++i) {
    EXPECT_EQ(sides.count({i, (i + 1) % 6}), 1u) << i;
  }
}

TEST(TriangulateTest, GivesNoneForFewerThanThreeCorners) {
  PolygonMesh mesh;
  mesh.positions.assign(2, {0, 0, 0});
  mesh.AddFace({});
  mesh.AddFace(std::array<uint32_t, 1>{0});
  mesh.AddFace(std::array<uint32_t, 2>{0, 1});
  std::vector<std::array<uint32_t, 3>> triangles;
  for (size_t f = 0; f < 3; ++f) Triangulate(mesh, f, &triangles);
  EXPECT_TRUE(triangles.empty());
}

TEST(TriangulateTest, EndsOnNumbersThatAreNotFinite) {
  PolygonMesh mesh;
  mesh.positions.assign(50, {NAN, INFINITY, 0});
  std::vector<uint32_t> corners(50);
  std::iota(corners.begin(), corners.end(), 0u);
  mesh.AddFace(corners);
  std::vector<std::array<uint32_t, 3>> triangles;
  Triangulate(mesh, 0, &triangles);
  EXPECT_EQ(triangles.size(), 48u);
}

}  // namespace
}  // namespace marrow
