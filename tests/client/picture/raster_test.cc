#include "client/picture/raster.h"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

namespace marrow {
namespace {

using Eigen::Vector3f;
using Triangles = std::vector<std::array<uint32_t, 3>>;

TEST(RasterTest, CoversTheSamplesWhoseCentreIsInside) {
  DepthBuffer buffer(8, 8);
  Rasterize({{0, 0, 5}, {8, 0, 5}, {0, 8, 5}}, {{0, 1, 2}}, buffer);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const bool inside = (x + 0.5) + (y + 0.5) <= 8;
      EXPECT_EQ(buffer.triangle[buffer.At(x, y)] == 0, inside) << x << " " << y;
    }
  }
}

TEST(RasterTest, LeavesNoGapBetweenNeighbours) {
  std::vector<Vector3f> points = {{31.7f, 28.3f, 0}};
  Triangles triangles;
  for (int i = 0; i <= 40; ++i) {
    const float angle = 2 * 3.14159265f * i / 40;
    points.push_back(
        {31.7f + 25 * std::cos(angle), 28.3f + 25 * std::sin(angle), 0});
  }
  for (uint32_t i = 1; i <= 40; ++i) triangles.push_back({0, i, i + 1});
  DepthBuffer buffer(64, 64);
  Rasterize(points, triangles, buffer);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      if (std::hypot(x + 0.5f - 31.7f, y + 0.5f - 28.3f) > 24) continue;
      EXPECT_NE(buffer.triangle[buffer.At(x, y)], kNoTriangle) << x << " " << y;
    }
  }
}

TEST(RasterTest, TheNearerTriangleWinsInAnyOrder) {
  const std::vector<Vector3f> points = {{0, 0, 1}, {9, 0, 1}, {0, 9, 1},
                                        {0, 0, 2}, {9, 0, 2}, {0, 9, 2}};
  for (const Triangles& triangles :
       {Triangles{{0, 1, 2}, {3, 4, 5}}, Triangles{{3, 4, 5}, {0, 1, 2}}}) {
    DepthBuffer buffer(4, 4);
    Rasterize(points, triangles, buffer);
    EXPECT_EQ(triangles[buffer.triangle[0]][0], 3u);
    EXPECT_EQ(buffer.depth[0], 2);
  }
}

TEST(RasterTest, InterpolatesDepth) {
  DepthBuffer buffer(16, 16);
  Rasterize({{0, 0, 0}, {16, 0, 16}, {0, 16, 32}}, {{0, 1, 2}}, buffer);
  EXPECT_NEAR(buffer.depth[buffer.At(3, 5)], 3.5 + 2 * 5.5, 1e-4);
}

TEST(RasterTest, TakesTrianglesOutsideAndWithoutArea) {
  DepthBuffer buffer(4, 4);
  Rasterize({{-9, -9, 0}, {-8, -9, 0}, {-9, -8, 0}, {2, 2, 0}, {3, 3, 0}},
            {{0, 1, 2}, {3, 3, 3}, {3, 4, 3}, {0, 3, 4}}, buffer);
  for (uint32_t t : buffer.triangle) EXPECT_EQ(t, kNoTriangle);
}

TEST(RasterTest, BoundsTheWorkAndKeepsTheNearest) {
  // A million sheets over the whole buffer, the nearest in the middle: 7e10
  // samples if all were drawn.
  const int kSheets = 1'000'000;
  std::vector<Vector3f> points;
  Triangles triangles;
  for (int i = 0; i < kSheets; ++i) {
    const float z = i == kSheets / 2 ? 9.0f : static_cast<float>(i % 8);
    const auto v = static_cast<uint32_t>(points.size());
    points.insert(points.end(), {{0, 0, z}, {999, 0, z}, {0, 999, z}});
    triangles.push_back({v, v + 1, v + 2});
  }
  DepthBuffer buffer(256, 256);
  const auto start = std::chrono::steady_clock::now();
  Rasterize(points, triangles, buffer);
  const std::chrono::duration<double> seconds =
      std::chrono::steady_clock::now() - start;
  EXPECT_EQ(buffer.triangle[0], uint32_t{kSheets / 2});
  EXPECT_LT(seconds.count(), 30);
}

}  // namespace
}  // namespace marrow
