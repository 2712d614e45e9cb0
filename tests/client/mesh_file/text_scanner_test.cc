#include "client/mesh_file/text_scanner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace marrow {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(TextScannerTest, SkipsBlankLinesAndCommentsAndCountsLines) {
  TextScanner scanner("f", "\xEF\xBB\xBF# head\n\n a  b#c\r\n\td\n");
  ASSERT_TRUE(scanner.NextLine());
  EXPECT_EQ(scanner.line(), 3u);
  EXPECT_EQ(scanner.NextToken(), "a");
  EXPECT_EQ(scanner.NextToken(), "b");
  EXPECT_EQ(scanner.NextToken(), "");
  ASSERT_TRUE(scanner.NextLine());
  EXPECT_EQ(scanner.line(), 4u);
  EXPECT_EQ(scanner.NextToken(), "d");
  EXPECT_FALSE(scanner.NextLine());
  EXPECT_FALSE(scanner.NextLine());
  EXPECT_EQ(scanner.NextTokenAcrossLines(), "");
}

TEST(TextScannerTest, ReadsOldMacLineEnds) {
  TextScanner scanner("f", "a\rb c\r");
  EXPECT_EQ(scanner.NextTokenAcrossLines(), "a");
  EXPECT_EQ(scanner.NextTokenAcrossLines(), "b");
  EXPECT_EQ(scanner.line(), 2u);
}

TEST(TextScannerTest, JoinsContinuedLines) {
  TextScanner scanner("f", "a \\\r\nb\\\nc\nd",
                      {.comments = true, .continuations = true});
  ASSERT_TRUE(scanner.NextLine());
  EXPECT_EQ(scanner.NextToken(), "a");
  EXPECT_EQ(scanner.NextToken(), "b");
  EXPECT_EQ(scanner.NextToken(), "c");
  EXPECT_EQ(scanner.NextToken(), "");
  ASSERT_TRUE(scanner.NextLine());
  EXPECT_EQ(scanner.NextToken(), "d");
  EXPECT_EQ(scanner.Error("bad").message(), "f: line 4: bad");
}

float Parsed(const std::string& token) {
  float value = -12345;
  EXPECT_TRUE(ParseFloat(token, &value)) << token;
  return value;
}

TEST(ParseFloatTest, RoundsCorrectly) {
  // Halfway between two floats but for the last digit.
  EXPECT_EQ(Parsed("1.00000005960464477539062500001"), 1.00000011920928955f);
  EXPECT_EQ(Parsed("16777217"), 16777216.0f);
  EXPECT_EQ(Parsed("+.5e1"), 5.0f);
  EXPECT_TRUE(std::signbit(Parsed("-0")));
}

TEST(ParseFloatTest, TakesWhatIsNotFinite) {
  EXPECT_TRUE(std::isnan(Parsed("NaN")));
  EXPECT_TRUE(std::isnan(Parsed("-nan")));
  EXPECT_EQ(Parsed("+inf"), kInfinity);
  EXPECT_EQ(Parsed("-Infinity"), -kInfinity);
}

TEST(ParseFloatTest, RoundsWhatIsOutOfRange) {
  EXPECT_EQ(Parsed("1e50"), kInfinity);
  EXPECT_EQ(Parsed("-1e5000"), -kInfinity);
  EXPECT_EQ(Parsed("1e-60"), 0.0f);
  EXPECT_EQ(Parsed("-1e-5000"), 0.0f);
  EXPECT_EQ(Parsed("1e-45"), std::numeric_limits<float>::denorm_min());
}

TEST(ParseFloatTest, RefusesOtherText) {
  float value = 0;
  for (const char* token : {"", "x", "1,5", "1.5x", "+-1", "--1", "0x10"}) {
    EXPECT_FALSE(ParseFloat(token, &value)) << token;
  }
}

TEST(ParseDoubleTest, RoundsCorrectlyAndWhatIsOutOfRange) {
  double value = 0;
  for (const auto& [token, expected] :
       std::map<std::string, double>{{"+1e300", 1e300},
                                     {"0.1", 0.1},
                                     {"1e-400", 0},
                                     {"-1e400", -HUGE_VAL},
                                     {"inf", HUGE_VAL}}) {
    EXPECT_TRUE(ParseDouble(token, &value)) << token;
    EXPECT_EQ(value, expected) << token;
  }
  EXPECT_FALSE(ParseDouble("1,5", &value));
}

bool TokenIsFloat(const std::string& token) {
  double value = 0;
  EXPECT_TRUE(ParseDouble(token, &value)) << token;
  return FloatSays(token, value);
}

TEST(FloatSaysTest, AsMuchAsTheDigitsDo) {
  for (const char* token :
       {"0", "-1", "0.1", "+0.3333333", "0.333333343", "16777216", "1e30",
        "1.1754944e-38", "1e-45", "123456.7", "0.10000000149011612", "nan",
        "-inf", "3.4028235e38", "1.E-2"}) {
    EXPECT_TRUE(TokenIsFloat(token)) << token;
  }
  for (const char* token : {"16777217", "0.3333333333", "10000000.5", "1e39",
                            "1e-50", "1234567.89", "1.0000000001e-3"}) {
    EXPECT_FALSE(TokenIsFloat(token)) << token;
  }
}

TEST(QuotedTest, IsShortAndPrintable) {
  EXPECT_EQ(Quoted("a\tb"), "'a?b'");
  EXPECT_EQ(Quoted(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
}

}  // namespace
}  // namespace marrow
