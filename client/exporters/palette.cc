#include "client/exporters/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace marrow {
namespace {

using LinearRgb = std::array<double, 3>;

// OKLCH (B. Ottosson, "A perceptual color space for image processing", 2020)
// to linear sRGB, which may lie outside of 0..1.
LinearRgb FromOklch(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(hue);
  const double b = chroma * std::sin(hue);
  const double l = lightness + 0.3963377774 * a + 0.2158037573 * b;
  const double m = lightness - 0.1055613458 * a - 0.0638541728 * b;
  const double s = lightness - 0.0894841775 * a - 1.2914855480 * b;
  const double l3 = l * l * l;
  const double m3 = m * m * m;
  const double s3 = s * s * s;
  return {4.0767416621 * l3 - 3.3077115913 * m3 + 0.2309699292 * s3,
          -1.2684380046 * l3 + 2.6097574011 * m3 - 0.3413193965 * s3,
          -0.0041960863 * l3 - 0.7034186147 * m3 + 1.7076147010 * s3};
}

bool InGamut(const LinearRgb& color) {
  return std::all_of(color.begin(), color.end(),
                     [](double c) { return c >= 0 && c <= 1; });
}

uint8_t EncodeSrgb(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  const double encoded =
      c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<uint8_t>(std::lround(255 * encoded));
}

}  // namespace

Rgb SegmentColor(uint32_t id) {
  // Steps of the golden angle come close to an earlier hue after 3, 5, 8 and
  // 13 steps; this order of seven lightnesses sets those apart.
  constexpr double kGoldenTurn = 0.3819660112501051;
  constexpr double kFirstHue = 0.69;
  constexpr std::array<double, 7> kLightness = {0.72, 0.60, 0.76, 0.64,
                                                0.80, 0.68, 0.84};
  const double turn = kFirstHue + kGoldenTurn * id;
  const double hue = 2 * std::numbers::pi * (turn - std::floor(turn));
  double chroma = 0.145;
  LinearRgb color = FromOklch(kLightness[id % kLightness.size()], chroma, hue);
  while (!InGamut(color) && chroma > 0) {
    chroma -= 0.005;
    color = FromOklch(kLightness[id % kLightness.size()], chroma, hue);
  }
  return {EncodeSrgb(color[0]), EncodeSrgb(color[1]), EncodeSrgb(color[2])};
}

}  // namespace marrow
