#include "client/exporters/palette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace marrow {
namespace {

double Linear(uint8_t encoded) {
  const double c = encoded / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

std::array<double, 3> Oklab(const Rgb& color) {
  const double r = Linear(color.red);
  const double g = Linear(color.green);
  const double b = Linear(color.blue);
  const double l =
      std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m =
      std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s =
      std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

double Distance(const Rgb& a, const Rgb& b) {
  const auto u = Oklab(a);
  const auto v = Oklab(b);
  return std::hypot(u[0] - v[0], u[1] - v[1], u[2] - v[2]);
}

TEST(PaletteTest, SiblingsAreFarApart) {
  for (uint32_t id = 0; id < 500; ++id) {
    EXPECT_GT(Distance(SegmentColor(id), SegmentColor(id + 1)), 0.15) << id;
  }
}

TEST(PaletteTest, SixteenConsecutiveColorsDiffer) {
  for (uint32_t id = 0; id < 500; ++id) {
    for (uint32_t step = 1; step < 16; ++step) {
      EXPECT_GT(Distance(SegmentColor(id), SegmentColor(id + step)), 0.05)
          << id << " and " << id + step;
    }
  }
}

TEST(PaletteTest, IsNeitherNearWhiteNorNearBlack) {
  for (uint32_t id = 0; id < 500; ++id) {
    const double lightness = Oklab(SegmentColor(id))[0];
    EXPECT_GT(lightness, 0.5) << id;
    EXPECT_LT(lightness, 0.88) << id;
  }
}

TEST(PaletteTest, TakesAnyId) {
  EXPECT_EQ(SegmentColor(0xFFFFFFFFu), SegmentColor(0xFFFFFFFFu));
}

}  // namespace
}  // namespace marrow
