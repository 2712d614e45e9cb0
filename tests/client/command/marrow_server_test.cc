// `marrow` against a real `marrowd`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/testing/subprocess.h"

namespace marrow {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using testing::Finished;
using ::testing::HasSubstr;
using testing::ListFolder;
using testing::ProgramPath;
using testing::ReadFile;
using testing::RunProgram;
using testing::Subprocess;
using testing::TemporaryFolder;

class MarrowServerTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    daemon_ = StartDaemon().release();
    address_ = AddressOf(*daemon_);
    ASSERT_EQ(Sample("humanoid", "10000", "h.off").code, 0);
  }
  static void TearDownTestSuite() {
    daemon_->Signal(SIGTERM);
    EXPECT_EQ(daemon_->Wait(), 0);
    delete daemon_;
    delete folder_;
  }

  static std::unique_ptr<Subprocess> StartDaemon(
      const std::string& log_level = "off") {
    return std::make_unique<Subprocess>(std::vector<std::string>{
        ProgramPath("marrowd"), "--port", "0", "--log-level", log_level});
  }
  static std::string AddressOf(Subprocess& daemon) {
    const std::string words = "listening on ";
    EXPECT_TRUE(daemon.WaitForOutput("\n"));
    const std::string line = daemon.Out();
    return line.substr(line.find(words) + words.size(),
                       line.size() - line.find(words) - words.size() - 1);
  }

  static Finished Sample(const std::string& name, const std::string& faces,
                         const std::string& file) {
    return RunProgram({ProgramPath("marrow"), "sample", name, "--faces", faces,
                       "-o", *folder_ / file});
  }
  static std::string File(const std::string& name) { return *folder_ / name; }

  static TemporaryFolder* folder_;
  static Subprocess* daemon_;
  static std::string address_;
};

TemporaryFolder* MarrowServerTest::folder_ = nullptr;
Subprocess* MarrowServerTest::daemon_ = nullptr;
std::string MarrowServerTest::address_;

TEST_F(MarrowServerTest, HealthSaysServing) {
  EXPECT_EQ(
      RunProgram({ProgramPath("marrow"), "health", "--server", address_}).code,
      0);
  EXPECT_EQ(RunProgram({ProgramPath("marrow"), "health"},
                       {"MARROW_SERVER=" + address_})
                .code,
            0);
}

TEST_F(MarrowServerTest, CutsAgainWhatItHasSegmented) {
  const auto call = [&](const std::string& command, const std::string& cut,
                        const std::string& out) {
    return RunProgram({ProgramPath("marrow"), command, File("h.off"),
                       "--method", "merge", "--pairs", "60", "--server",
                       address_, "--cut", cut, "-o", File(out)});
  };
  const Finished early = call("cut", "auto", "early");
  EXPECT_EQ(early.code, 1);
  EXPECT_THAT(early.err, HasSubstr("marrow segment"));
  EXPECT_FALSE(std::filesystem::exists(File("early")));

  ASSERT_EQ(call("segment", "segments:4", "once").code, 0);
  const Finished again = call("cut", "segments:4", "again");
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(ReadFile(File("again/h.cut.seg")),
            ReadFile(File("once/h.cut.seg")));
  EXPECT_EQ(ReadFile(File("again/h.cut.ply")),
            ReadFile(File("once/h.cut.ply")));
  const json once = json::parse(ReadFile(File("once/h.json")));
  const json cut = json::parse(ReadFile(File("again/h.cut.json")));
  EXPECT_EQ(cut["cut"], once["cut"]);
  EXPECT_EQ(cut["cache"]["result"], "hit");
  EXPECT_EQ(cut["cache"]["solver_runs"], 0);

  const Finished bad = call("cut", "level:4", "bad");
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.err, HasSubstr("--cut is 4"));
}

TEST_F(MarrowServerTest, AServerAndTheEmbeddedServiceGiveTheSameFiles) {
  const Finished remote =
      RunProgram({ProgramPath("marrow"), "segment", File("h.off"), "-o",
                  File("remote"), "--server", address_});
  ASSERT_EQ(remote.code, 0) << remote.err;
  ASSERT_EQ(RunProgram({ProgramPath("marrow"), "segment", File("h.off"), "-o",
                        File("embedded")})
                .code,
            0);
  const std::vector<std::string> names = ListFolder(File("remote"));
  EXPECT_EQ(names.size(), 10u);
  ASSERT_EQ(ListFolder(File("embedded")), names);
  for (const std::string& name : names) {
    const std::string a = ReadFile(File("remote/" + name));
    const std::string b = ReadFile(File("embedded/" + name));
    if (!name.ends_with(".json")) {
      EXPECT_EQ(a, b) << name;
      continue;
    }
    json first = json::parse(a);
    json second = json::parse(b);
    for (json* each : {&first, &second}) {
      each->erase("timings");
      each->erase("cache");
    }
    EXPECT_EQ(first, second);
  }
}

TEST_F(MarrowServerTest, TheSecondCallNeedsNoSolver) {
  const std::vector<std::string> command = {ProgramPath("marrow"),
                                            "segment",
                                            File("h.off"),
                                            "-o",
                                            File("twice"),
                                            "--pairs",
                                            "60",
                                            "--server",
                                            address_};
  ASSERT_EQ(RunProgram(command).code, 0);
  const std::string labels = ReadFile(File("twice/h.seg"));
  const Finished second = RunProgram(command);
  EXPECT_THAT(second.out, HasSubstr("spectrum kept"));
  const json result = json::parse(ReadFile(File("twice/h.json")));
  EXPECT_EQ(result["cache"]["outcome"], "hit");
  EXPECT_EQ(result["cache"]["solver_runs"], 0);
  EXPECT_EQ(ReadFile(File("twice/h.seg")), labels);
}

TEST_F(MarrowServerTest, ACommandIsOneCall) {
  const std::unique_ptr<Subprocess> daemon = StartDaemon("info");
  for (const char* command : {"segment", "segment", "cut"}) {
    const Finished run =
        RunProgram({ProgramPath("marrow"), command, File("h.off"), "-o",
                    File("one"), "--server", AddressOf(*daemon)});
    ASSERT_EQ(run.code, 0) << run.err;
  }
  daemon->Signal(SIGTERM);
  EXPECT_EQ(daemon->Wait(), 0);
  std::vector<std::string> methods;
  std::istringstream lines(daemon->Err());
  for (std::string line; std::getline(lines, line);) {
    const json record = json::parse(line);
    if (record["message"] == "call") methods.push_back(record["method"]);
  }
  EXPECT_THAT(methods, ElementsAre("SegmentationService.Segment",
                                   "SegmentationService.Segment",
                                   "SegmentationService.Cut"));
}

TEST_F(MarrowServerTest, AServerThatIsLostEndsTheRunWithItsOwnExitCode) {
  const std::unique_ptr<Subprocess> daemon = StartDaemon();
  ASSERT_EQ(Sample("octopus", "50000", "big.off").code, 0);
  Subprocess client({ProgramPath("marrow"), "segment", File("big.off"),
                     File("h.off"), "-o", File("lost"), "--pairs", "1000",
                     "--threads", "1", "--json", "--server",
                     AddressOf(*daemon)});
  ASSERT_TRUE(client.WaitForOutput("\"stage\":\"spectrum\""));
  daemon->Signal(SIGKILL);
  EXPECT_EQ(client.Wait(), 3);
  EXPECT_THAT(client.Out(), HasSubstr("\"skipped\":1"));
  EXPECT_THAT(client.Out(), HasSubstr("the server was lost"));
  EXPECT_FALSE(std::filesystem::exists(File("lost")));
}

// A rough sheet, whose payload is above the 1 MiB that goes inline.
TEST_F(MarrowServerTest, ALargeMeshIsUploadedOnceAndThenNamed) {
  constexpr int kSide = 400;
  std::ostringstream off;
  off << "OFF\n" << kSide * kSide << " " << (kSide - 1) * (kSide - 1) << " 0\n";
  uint32_t noise = 1;
  for (int i = 0; i < kSide * kSide; ++i) {
    noise = noise * 1664525u + 1013904223u;
    off << i % kSide << " " << i / kSide << " " << noise * 1e-9 << "\n";
  }
  for (int i = 0; i + kSide < kSide * kSide; ++i) {
    if (i % kSide == kSide - 1) continue;
    off << "4 " << i << " " << i + 1 << " " << i + kSide + 1 << " " << i + kSide
        << "\n";
  }
  marrow::testing::WriteFile(File("sheet.off"), off.str());
  const std::vector<std::string> command = {ProgramPath("marrow"),
                                            "inspect",
                                            File("sheet.off"),
                                            "--json",
                                            "--server",
                                            address_};
  const Finished first = RunProgram(command);
  ASSERT_EQ(first.code, 0) << first.err;
  const json report = json::parse(first.out);
  EXPECT_EQ(report["report"]["faces"], 2 * (kSide - 1) * (kSide - 1));
  EXPECT_EQ(report["report"]["boundary_loops"], 1);
  EXPECT_EQ(json::parse(RunProgram(command).out)["report"], report["report"]);
}

TEST_F(MarrowServerTest, ADracoFileIsLabelledInItsOwnOrder) {
  ASSERT_EQ(Sample("humanoid", "10000", "h.drc").code, 0);
  const Finished run =
      RunProgram({ProgramPath("marrow"), "segment", File("h.drc"), "-o",
                  File("drc"), "--server", address_});
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string labels = ReadFile(File("drc/h.seg"));
  EXPECT_EQ(std::count(labels.begin(), labels.end(), '\n'), 10000);
}

}  // namespace
}  // namespace marrow
