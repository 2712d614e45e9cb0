#include "core/base/digest.h"

#include <string>

#include "gtest/gtest.h"

namespace marrow {
namespace {

// The examples of FIPS 180-4.
TEST(DigestTest, IsSha256) {
  EXPECT_EQ(Sha256("").Hex(),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256("abc").Hex(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(DigestTest, AddsInParts) {
  const std::string text(1000, 'x');
  DigestBuilder builder("");
  builder.Add(text.data(), 300);
  builder.Add(text.data(), 0);
  builder.Add(text.data(), 700);
  EXPECT_EQ(builder.Finish(), Sha256(text));
}

TEST(DigestTest, NumbersAreLittleEndian) {
  DigestBuilder builder("");
  builder.AddU64(0x0807060504030201);
  EXPECT_EQ(builder.Finish(), Sha256("\1\2\3\4\5\6\7\10"));
}

Digest OfStrings(const std::string& tag, const std::string& a,
                 const std::string& b) {
  DigestBuilder builder(tag);
  builder.AddString(a);
  builder.AddString(b);
  return builder.Finish();
}

TEST(DigestTest, KeepsTagsAndStringsApart) {
  EXPECT_EQ(OfStrings("tag", "ab", "c"), OfStrings("tag", "ab", "c"));
  EXPECT_NE(OfStrings("tag", "ab", "c"), OfStrings("tag", "a", "bc"));
  EXPECT_NE(OfStrings("tag", "ab", "c"), OfStrings("gat", "ab", "c"));
  EXPECT_NE(OfStrings("tag", "ab", "c"), OfStrings("", "ab", "c"));
}

TEST(DigestTest, IsOrderedByItsBytes) {
  Digest low, high;
  low.bytes[31] = 200;
  high.bytes[0] = 1;
  EXPECT_LT(low, high);
  EXPECT_LT(low.Hex(), high.Hex());
}

}  // namespace
}  // namespace marrow
