#include "server/json_log.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace marrow {
namespace {

TEST(JsonLogTest, HostileBytesStayOneObjectOnOneLine) {
  const std::string hostile = "a\"}\n{\"level\":\"\xff\\\x01";
  const LogRecord record{LogLevel::kError, hostile, {{"error", hostile}}, 1.5};
  const std::string line = ToJsonLine(record, "now");
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json.size(), 5u);
  EXPECT_EQ(json["time"], "now");
  EXPECT_EQ(json["level"], "error");
  EXPECT_EQ(json["seconds"], 1.5);
  EXPECT_EQ(json["error"].get<std::string>().substr(0, 4), "a\"}\n");
}

TEST(JsonLogTest, ALongValueIsCut) {
  const LogRecord record{LogLevel::kInfo, std::string(1 << 20, 'x'), {}, {}};
  EXPECT_LT(ToJsonLine(record, "now").size(), 2000u);
}

}  // namespace
}  // namespace marrow
