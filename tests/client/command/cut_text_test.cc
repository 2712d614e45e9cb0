#include "client/command/cut_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace marrow::client {
namespace {

using ::testing::HasSubstr;

v1::Cut Parsed(const std::string& text, std::vector<uint32_t> closed = {},
               std::vector<uint32_t> open = {}) {
  return ToMessage(CutChoice{text, std::move(closed), std::move(open)});
}

TEST(CutTextTest, SaysWhatIsMeant) {
  for (const char* good : {"auto", "level:2", "segments:12", "salience:0.5",
                           "salience:-1", "level:0"}) {
    EXPECT_EQ(CheckCutText(good), "") << good;
  }
  EXPECT_EQ(Parsed("auto").by_case(), v1::Cut::BY_NOT_SET);
  EXPECT_EQ(Parsed("level:2").level(), 2u);
  EXPECT_EQ(Parsed("segments:12").segments(), 12u);
  EXPECT_EQ(Parsed("salience:0.5").salience(), 0.5);
  const v1::Cut cut = Parsed("auto", {3, 1}, {2});
  EXPECT_EQ(cut.closed(0), 3u);
  EXPECT_EQ(cut.closed(1), 1u);
  EXPECT_EQ(cut.open(0), 2u);
}

TEST(CutTextTest, WhatIsNoneSaysWhatIsAllowed) {
  for (const char* bad : {"",
                          "automatic",
                          "level",
                          "level:",
                          "level:x",
                          "level:-1",
                          "level:1.5",
                          "segments:99999999999",
                          "segment:3",
                          "salience:much",
                          ":3",
                          "5",
                          "level: 1",
                          "level:+1",
                          "level:-0",
                          "level:010",
                          "level:1 ",
                          "salience:0x1p-1",
                          "salience: 0.5",
                          "salience:nan",
                          "salience:"}) {
    EXPECT_THAT(CheckCutText(bad),
                HasSubstr("is no cut; allowed are auto, level:N"))
        << bad;
  }
}

}  // namespace
}  // namespace marrow::client
