#include "server/json_log.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

// What a log writes into, and whoever reads it.
class Pipe {
 public:
  Pipe() {
    signal(SIGPIPE, SIG_IGN);
    EXPECT_EQ(pipe2(ends_, O_CLOEXEC), 0);
  }
  ~Pipe() {
    CloseWriter();
    close(ends_[0]);
  }

  int writer() const { return ends_[1]; }
  void CloseWriter() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

  // `count` lines, as objects.
  std::vector<nlohmann::json> Read(size_t count) {
    std::vector<nlohmann::json> lines;
    std::string line;
    for (char c = 0; lines.size() < count && read(ends_[0], &c, 1) == 1;) {
      line += c;
      if (c != '\n') continue;
      lines.push_back(nlohmann::json::parse(line));
      line.clear();
    }
    return lines;
  }

 private:
  int ends_[2];
};

TEST(JsonLogTest, LinesBelowTheLevelAreLeftOut) {
  Pipe pipe;
  JsonLog log("warning", pipe.writer());
  log.Write({LogLevel::kInfo, "quiet", {}, {}});
  log.Write({LogLevel::kError, "loud", {}, {}});
  ASSERT_TRUE(log.Flush(absl::Seconds(30)));
  EXPECT_EQ(pipe.Read(1).at(0)["message"], "loud");
}

TEST(JsonLogTest, NobodyWaitsForAReaderAndLostLinesAreCounted) {
  constexpr int kLines = 3000;  // of a kilobyte: more than pipe and log hold
  Pipe pipe;
  JsonLog log("info", pipe.writer());
  const std::string text(1000, 'x');
  for (int i = 0; i < kLines; ++i) log.Write({LogLevel::kInfo, text, {}, {}});
  EXPECT_FALSE(log.Flush(absl::Milliseconds(1)));

  int written = 0;
  std::string dropped;
  while (dropped.empty()) {
    const nlohmann::json line = pipe.Read(1).at(0);
    dropped = line.value("dropped", "");
    written += dropped.empty();
  }
  EXPECT_GT(written, 1000);
  EXPECT_LT(written, kLines);
  EXPECT_EQ(written + std::stoi(dropped), kLines);

  log.Write({LogLevel::kInfo, "afterwards", {}, {}});
  EXPECT_EQ(pipe.Read(1).at(0)["message"], "afterwards");
}

TEST(JsonLogTest, ADescriptorThatDoesNotBlockLosesNothing) {
  constexpr int kLines = 300;
  Pipe pipe;
  ASSERT_EQ(fcntl(pipe.writer(), F_SETFL, O_NONBLOCK), 0);
  JsonLog log("info", pipe.writer());
  const std::string text(1000, 'x');
  for (int i = 0; i < kLines; ++i) log.Write({LogLevel::kInfo, text, {}, {}});
  EXPECT_EQ(pipe.Read(kLines).size(), size_t{kLines});
}

}  // namespace
}  // namespace marrow
