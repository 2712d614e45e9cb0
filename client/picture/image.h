// An image in linear light, and its PNG.
#ifndef MARROW_CLIENT_PICTURE_IMAGE_H_
#define MARROW_CLIENT_PICTURE_IMAGE_H_

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/exporters/palette.h"

namespace marrow {

// Linear light, 0 to 1 a channel.
using Color = Eigen::Vector3f;

Color ToLinear(const Rgb& srgb);

struct Image {
  Image(int width, int height, const Color& color)
      : width(width),
        height(height),
        pixels(static_cast<size_t>(width) * height, color) {}

  Color& At(int x, int y) { return pixels[static_cast<size_t>(y) * width + x]; }

  int width;
  int height;
  std::vector<Color> pixels;  // row-major, the top row first
};

// An 8-bit sRGB PNG without a time stamp. Internal where libpng fails.
absl::StatusOr<std::string> EncodePng(const Image& image);

}  // namespace marrow

#endif  // MARROW_CLIENT_PICTURE_IMAGE_H_
