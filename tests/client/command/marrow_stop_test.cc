// `marrow segment` that is stopped, by signals and by time, and what it leaves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>

#include "tests/client/command/segment_fixture.h"
#include "tests/testing/subprocess.h"

namespace marrow {
namespace {

using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramPath;
using testing::RunProgram;
using testing::Subprocess;

using MarrowStopTest = MarrowSegmentTest;

TEST_F(MarrowStopTest, ATimeoutEndsTheCallAndLeavesNothing) {
  const Finished run = Segment({Sample(), "--timeout", "0.001"});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("--timeout"));
  EXPECT_FALSE(std::filesystem::exists(Out()));
}

TEST_F(MarrowStopTest, ATimeoutEndsAReadThatNeverReturns) {
  const std::string pipe = folder_ / "pipe.off";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const Finished run =
      RunProgram({"/usr/bin/timeout", "30", ProgramPath("marrow"), "segment",
                  pipe, "-o", Out(), "--timeout", "0.3"});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("pipe.off: not done in time"));
  EXPECT_FALSE(std::filesystem::exists(Out()));
}

// A second signal would end the process without tidying; one must do.
TEST_F(MarrowStopTest, CtrlCEndsSoonAndLeavesNothing) {
  const std::string large = folder_ / "large.off";
  ASSERT_EQ(RunProgram({ProgramPath("marrow"), "sample", "octopus", "--faces",
                        "50000", "-o", large})
                .code,
            0);
  Subprocess process({ProgramPath("marrow"), "segment", large, "-o", Out(),
                      "--pairs", "1000", "--json"});
  ASSERT_TRUE(process.WaitForOutput("\"stage\":\"spectrum\""));
  const auto start = std::chrono::steady_clock::now();
  process.Signal(SIGINT);
  EXPECT_EQ(process.Wait(), 130);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_THAT(process.Out(), Not(HasSubstr("\"completed\"")));
  EXPECT_FALSE(std::filesystem::exists(Out()));
}

TEST_F(MarrowStopTest, ASignalThatIsIgnoredStaysSo) {
  for (const auto& [name, number] :
       {std::pair{"HUP", SIGHUP}, std::pair{"INT", SIGINT}}) {
    Subprocess process({"/bin/sh", "-c",
                        "trap '' " + std::string(name) + "; exec " +
                            ProgramPath("marrow") + " segment --json -o " +
                            Out() + " " + Sample()});
    ASSERT_TRUE(process.WaitForOutput("\"accepted\""));
    process.Signal(number);
    EXPECT_EQ(process.Wait(), 0) << name;
  }
}

TEST_F(MarrowStopTest, FoldersMadeForNothingGo) {
  const Finished run = RunProgram({ProgramPath("marrow"), "segment",
                                   folder_ / "none.off", "-o", Out("a/b/c")});
  EXPECT_EQ(run.code, 1);
  EXPECT_FALSE(std::filesystem::exists(Out()));
}

TEST_F(MarrowStopTest, CtrlCEndsAReadThatNeverReturns) {
  const std::string pipe = folder_ / "pipe.off";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  Subprocess process({ProgramPath("marrow"), "segment", Sample(), pipe, "-o",
                      Out(), "--levels", "1", "--threads", "1"});
  ASSERT_TRUE(process.WaitForOutput("octopus.seg"));
  process.Signal(SIGINT);
  EXPECT_EQ(process.Wait(), 130);
}

}  // namespace
}  // namespace marrow
