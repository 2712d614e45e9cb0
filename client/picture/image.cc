#include "client/picture/image.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace marrow {
namespace {

float ToLinear(uint8_t encoded) {
  const float c = encoded / 255.0f;
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

// sRGB bytes of linear values, tabulated finely enough to round as the formula
// does but for the darkest few.
class SrgbTable {
 public:
  SrgbTable() {
    for (int i = 0; i <= kSteps; ++i) {
      const double c = static_cast<double>(i) / kSteps;
      const double s =
          c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
      bytes_.push_back(static_cast<uint8_t>(std::lround(255 * s)));
    }
  }
  uint8_t operator()(float linear) const {
    const float c = std::clamp(linear, 0.0f, 1.0f);
    return bytes_[std::lround(c * kSteps)];
  }

 private:
  static constexpr int kSteps = 16384;
  std::vector<uint8_t> bytes_;
};

}  // namespace

Color ToLinear(const Rgb& srgb) {
  return {ToLinear(srgb.red), ToLinear(srgb.green), ToLinear(srgb.blue)};
}

absl::StatusOr<std::string> EncodePng(const Image& image) {
  const SrgbTable table;
  std::vector<uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 3);
  for (const Color& pixel : image.pixels) {
    for (int i = 0; i < 3; ++i) bytes.push_back(table(pixel[i]));
  }
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string out(size, '\0');
  if (!png_image_write_to_memory(&png, out.data(), &size, 0, bytes.data(), 0,
                                 nullptr)) {
    return absl::InternalError(
        absl::StrCat("cannot encode the picture: ", png.message));
  }
  out.resize(size);
  return out;
}

}  // namespace marrow
