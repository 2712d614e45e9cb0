// Which triangle is seen at each sample of a view.
#ifndef MARROW_CLIENT_PICTURE_RASTER_H_
#define MARROW_CLIENT_PICTURE_RASTER_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace marrow {

inline constexpr uint32_t kNoTriangle = 0xFFFFFFFFu;

// Row-major, the top row first. x grows to the right, y downwards, depth
// towards the viewer. Sample (column, row) has its centre at column + .5,
// row + .5.
struct DepthBuffer {
  DepthBuffer(int width, int height);

  size_t At(int x, int y) const { return size_t(y) * width + x; }

  int width;
  int height;
  std::vector<uint32_t> triangle;  // kNoTriangle where nothing is seen
  std::vector<float> depth;        // of that triangle
};

// Draws triangles whose points are given in samples. A tie in depth goes to the
// triangle with the lower number. Work is bounded: where the triangles would
// cover the buffer more than a hundred times, the nearest ones are drawn first
// and those left when the bound is reached are not drawn.
void Rasterize(const std::vector<Eigen::Vector3f>& points,
               const std::vector<std::array<uint32_t, 3>>& triangles,
               DepthBuffer& buffer);

}  // namespace marrow

#endif  // MARROW_CLIENT_PICTURE_RASTER_H_
