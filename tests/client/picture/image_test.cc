#include "client/picture/image.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/client/picture/shapes.h"

namespace marrow {
namespace {

TEST(ImageTest, EveryByteSurvivesLinearLightAndPng) {
  Image image(16, 16, Color::Zero());
  for (int i = 0; i < 256; ++i) {
    const auto byte = static_cast<uint8_t>(i);
    const auto inverse = static_cast<uint8_t>(255 - i);
    image.At(i % 16, i / 16) = ToLinear({byte, inverse, 77});
  }
  const DecodedPng png = DecodePng(EncodePng(image).value());
  ASSERT_EQ(png.width, 16);
  ASSERT_EQ(png.height, 16);
  for (int i = 0; i < 256; ++i) {
    const Rgb& pixel = png.At(i % 16, i / 16);
    EXPECT_EQ(pixel.red, i);
    EXPECT_EQ(pixel.green, 255 - i);
    EXPECT_EQ(pixel.blue, 77);
  }
}

TEST(ImageTest, ClampsWhatIsTooBrightOrDark) {
  Image image(2, 1, Color(1e30f, 2, -3));
  const DecodedPng png = DecodePng(EncodePng(image).value());
  EXPECT_EQ(png.At(0, 0), (Rgb{255, 255, 0}));
}

}  // namespace
}  // namespace marrow
