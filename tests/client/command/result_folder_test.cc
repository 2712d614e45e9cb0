#include "client/command/result_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/testing/subprocess.h"

namespace marrow::client {
namespace {

using marrow::testing::ListFolder;
using marrow::testing::ReadFile;
using marrow::testing::TemporaryFolder;
using marrow::testing::WriteFile;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ResultFolderTest, TheStemIsTheNameWithoutFolderAndExtension) {
  EXPECT_EQ(StemOf("a/b.c/homer.off"), "homer");
  EXPECT_EQ(StemOf("x.tar.obj"), "x.tar");
  EXPECT_EQ(StemOf("plain"), "plain");
  EXPECT_EQ(StemOf("-"), "stdin");
  EXPECT_EQ(StemOf("-.off"), "-");
}

TEST(ResultFolderTest, KnowsItsOwnFilesFromOthers) {
  for (const char* name :
       {"a.seg", "a.json", "a.parts.obj", "a.level-1.seg", "a.level-12.ply",
        "a.level-3.png", "a.cut.seg", "a.cut.ply", "a.cut.png", "a.cut.json",
        "a.cut.parts.obj"}) {
    EXPECT_TRUE(IsResultName("a", name)) << name;
  }
  for (const char* name :
       {"a.off", "a.obj", "ab.seg", "a.level-.seg", "a.level-1.obj", "a",
        "a.level-1x.ply", "b.json", "a.level-1.ply.bak", "a.cut", "a.cut.obj",
        "a.cuts.seg"}) {
    EXPECT_FALSE(IsResultName("a", name)) << name;
  }
}

TEST(ResultFolderTest, RefusesInputsThatWouldWriteOneFile) {
  EXPECT_TRUE(CheckStems({"a.off", "b.off", "x/c.off"}).ok());
  EXPECT_TRUE(CheckStems({"a.off", "a.levels.off", "a.level-x.off"}).ok());
  for (const char* other :
       {"y/a.obj", "./a.off", "a.level-2.ply", "a.parts.obj", "a.cut.off"}) {
    const absl::Status status = CheckStems({"a.off", other});
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << other;
    EXPECT_THAT(std::string(status.message()), HasSubstr(other));
  }
}

TEST(ResultFolderTest, ReplacesAllResultsOfAnEarlierRunAndNothingElse) {
  const TemporaryFolder folder;
  for (const char* name : {"a.seg", "a.level-3.seg", "a.level-3.png", "a.off",
                           "ab.seg", "a.parts.obj"}) {
    WriteFile(folder / name, "old");
  }
  ASSERT_TRUE(PublishResults(folder.path(), "a",
                             {{"a.seg", "new"}, {"a.level-1.seg", "new"}})
                  .ok());
  EXPECT_THAT(ListFolder(folder.path()),
              ElementsAre("a.level-1.seg", "a.off", "a.seg", "ab.seg"));
  EXPECT_EQ(ReadFile(folder / "a.seg"), "new");
  EXPECT_EQ(ReadFile(folder / "ab.seg"), "old");
}

TEST(ResultFolderTest, ACutReplacesAnEarlierCutAlone) {
  const TemporaryFolder folder;
  for (const char* name :
       {"a.seg", "a.level-1.seg", "a.cut.seg", "a.cut.png"}) {
    WriteFile(folder / name, "old");
  }
  ASSERT_TRUE(PublishResults(folder.path(), "a",
                             {{"a.cut.seg", "new"}, {"a.cut.json", "new"}},
                             ResultScope::kCut)
                  .ok());
  EXPECT_THAT(ListFolder(folder.path()),
              ElementsAre("a.cut.json", "a.cut.seg", "a.level-1.seg", "a.seg"));
  EXPECT_EQ(ReadFile(folder / "a.cut.seg"), "new");
}

// A folder stands where a file must go: all is as it was before.
TEST(ResultFolderTest, AfterAFailureTheOldResultsStand) {
  const TemporaryFolder folder;
  WriteFile(folder / "a.level-3.seg", "old");
  WriteFile(folder / "a.seg", "old");
  std::filesystem::create_directories(folder / "a.json/mine");
  const absl::Status status = PublishResults(
      folder.path(), "a",
      {{"a.seg", "new"}, {"a.level-1.seg", "new"}, {"a.json", "new"}});
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()), HasSubstr(folder / "a.json"));
  EXPECT_THAT(ListFolder(folder.path()),
              ElementsAre("a.json", "a.level-3.seg", "a.seg"));
  EXPECT_EQ(ReadFile(folder / "a.seg"), "old");
  EXPECT_TRUE(std::filesystem::exists(folder / "a.json/mine"));
}

TEST(ResultFolderTest, MakesFoldersAndRefusesWhatCannotBeOne) {
  const TemporaryFolder folder;
  EXPECT_TRUE(PrepareFolder(folder / "x/y").value());
  EXPECT_FALSE(PrepareFolder(folder / "x/y").value());
  EXPECT_TRUE(ListFolder(folder / "x/y").empty());
  WriteFile(folder / "file", "");
  const absl::Status status = PrepareFolder(folder / "file").status();
  EXPECT_THAT(std::string(status.message()), HasSubstr("-o"));
}

}  // namespace
}  // namespace marrow::client
