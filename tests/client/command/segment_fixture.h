// A creature to segment, and a folder for what comes of it.
#ifndef MARROW_TESTS_CLIENT_COMMAND_SEGMENT_FIXTURE_H_
#define MARROW_TESTS_CLIENT_COMMAND_SEGMENT_FIXTURE_H_

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "tests/testing/subprocess.h"

namespace marrow {

inline std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class MarrowSegmentTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new testing::TemporaryFolder;
    const testing::Finished made =
        testing::RunProgram({testing::ProgramPath("marrow"), "sample",
                             "octopus", "--faces", "5000", "-o", Sample()});
    ASSERT_EQ(made.code, 0) << made.err;
  }
  static void TearDownTestSuite() { delete shared_; }
  static std::string Sample() { return *shared_ / "octopus.off"; }

  testing::Finished Segment(std::vector<std::string> arguments) {
    std::vector<std::string> command = {testing::ProgramPath("marrow"),
                                        "segment", "-o", Out()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return testing::RunProgram(command);
  }
  std::string Out(const std::string& name = "") const {
    return (folder_ / "out") + (name.empty() ? "" : "/" + name);
  }

  static inline testing::TemporaryFolder* shared_ = nullptr;
  testing::TemporaryFolder folder_;
};

}  // namespace marrow

#endif  // MARROW_TESTS_CLIENT_COMMAND_SEGMENT_FIXTURE_H_
