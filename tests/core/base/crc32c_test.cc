#include "core/base/crc32c.h"

#include <gtest/gtest.h>

#include <string>

namespace marrow {
namespace {

TEST(Crc32cTest, GivesTheVectorsOfRfc3720) {
  EXPECT_EQ(Crc32c(std::string(32, '\0')), 0x8A9136AAu);
  EXPECT_EQ(Crc32c(std::string(32, '\xFF')), 0x62A8AB43u);
  EXPECT_EQ(Crc32c("123456789"), 0xE3069283u);
  EXPECT_EQ(Crc32c(""), 0u);
}

TEST(Crc32cTest, TellsEveryFlippedBitOfAMessageOfAnyLength) {
  for (size_t length = 1; length < 20; ++length) {
    const std::string message(length, 'm');
    for (size_t bit = 0; bit < 8 * length; ++bit) {
      std::string flipped = message;
      flipped[bit / 8] ^= static_cast<char>(1 << (bit % 8));
      EXPECT_NE(Crc32c(flipped), Crc32c(message)) << length << " " << bit;
    }
  }
}

}  // namespace
}  // namespace marrow
