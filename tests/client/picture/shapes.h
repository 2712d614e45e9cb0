// Solids made of quads, and a PNG reader, for the tests of pictures.
#ifndef MARROW_TESTS_CLIENT_PICTURE_SHAPES_H_
#define MARROW_TESTS_CLIENT_PICTURE_SHAPES_H_

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "client/exporters/palette.h"
#include "client/polygon_mesh.h"

namespace marrow {

struct LabelledMesh {
  PolygonMesh mesh;
  std::vector<uint32_t> labels;
};

using Corner = std::array<double, 3>;

// Adds the box between two corners: six quads, normals outwards.
inline void AddBox(const Corner& low, const Corner& high, uint32_t label,
                   LabelledMesh& out) {
  const auto first = static_cast<uint32_t>(out.mesh.positions.size());
  for (int i = 0; i < 8; ++i) {
    out.mesh.positions.push_back({i & 1 ? high[0] : low[0],
                                  i & 2 ? high[1] : low[1],
                                  i & 4 ? high[2] : low[2]});
  }
  constexpr std::array<std::array<uint32_t, 4>, 6> kFaces = {{{0, 2, 3, 1},
                                                              {4, 5, 7, 6},
                                                              {0, 1, 5, 4},
                                                              {2, 6, 7, 3},
                                                              {0, 4, 6, 2},
                                                              {1, 3, 7, 5}}};
  for (auto face : kFaces) {
    for (uint32_t& v : face) v += first;
    out.mesh.AddFace(face);
    out.labels.push_back(label);
  }
}

// A body along x on four legs, with a neck at one end; y is up. The body is
// segment 0, the legs are 1 to 4, the neck is 5.
inline LabelledMesh MakeQuadruped() {
  LabelledMesh animal;
  AddBox({-2, 0, -0.5f}, {2, 1, 0.5f}, 0, animal);
  uint32_t label = 1;
  for (float x : {-1.9f, 1.5f}) {
    for (float z : {-0.5f, 0.2f}) {
      AddBox({x, -1.5f, z}, {x + 0.4f, 0, z + 0.3f}, label++, animal);
    }
  }
  AddBox({1.5f, 1, -0.2f}, {2, 2, 0.2f}, 5, animal);
  return animal;
}

// The same shape with z up.
inline void TurnZUp(PolygonMesh& mesh) {
  for (auto& [x, y, z] : mesh.positions) {
    const float old_y = y;
    y = -z;
    z = old_y;
  }
}

struct DecodedPng {
  int width = 0;
  int height = 0;
  std::vector<Rgb> pixels;

  const Rgb& At(int x, int y) const { return pixels[size_t(y) * width + x]; }
};

inline DecodedPng DecodePng(const std::string& bytes) {
  DecodedPng decoded;
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) {
    ADD_FAILURE() << png.message;
    return decoded;
  }
  png.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> raw(PNG_IMAGE_SIZE(png));
  EXPECT_TRUE(png_image_finish_read(&png, nullptr, raw.data(), 0, nullptr));
  decoded.width = static_cast<int>(png.width);
  decoded.height = static_cast<int>(png.height);
  for (size_t i = 0; i < raw.size(); i += 3) {
    decoded.pixels.push_back({raw[i], raw[i + 1], raw[i + 2]});
  }
  return decoded;
}

// How much the hues differ: the angle between the colours' differences from
// gray, in degrees, or 180 for a gray.
inline double HueDifference(const Rgb& a, const Rgb& b) {
  const auto chroma = [](const Rgb& c) {
    return std::array<double, 2>{c.red - 0.5 * c.green - 0.5 * c.blue,
                                 std::sqrt(0.75) * (c.green - c.blue)};
  };
  const auto u = chroma(a);
  const auto v = chroma(b);
  const double length = std::hypot(u[0], u[1]) * std::hypot(v[0], v[1]);
  if (std::hypot(u[0], u[1]) < 25 || length == 0) return 180;
  return std::acos(std::min((u[0] * v[0] + u[1] * v[1]) / length, 1.0)) * 180 /
         3.14159265;
}

inline int CountHue(const DecodedPng& png, const Rgb& color) {
  int count = 0;
  for (const Rgb& pixel : png.pixels) {
    if (HueDifference(pixel, color) < 8) ++count;
  }
  return count;
}

}  // namespace marrow

#endif  // MARROW_TESTS_CLIENT_PICTURE_SHAPES_H_
