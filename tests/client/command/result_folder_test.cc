#include "client/command/result_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "client/command/staging_folder.h"
#include "tests/testing/subprocess.h"

namespace marrow::client {
namespace {

using marrow::testing::ListFolder;
using marrow::testing::ReadFile;
using marrow::testing::TemporaryFolder;
using marrow::testing::WriteFile;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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

// As STEM.json lists what it was written with.
std::string Record(const std::string& files,
                   const std::string& schema = "marrow.segmentation/1") {
  return R"({"schema": ")" + schema + R"(", "files": [)" + files + "]}";
}

TEST(ResultFolderTest, ReplacesAllResultsOfAnEarlierRunAndNothingElse) {
  const TemporaryFolder folder;
  for (const char* name :
       {"a.seg", "a.level-3.seg", "a.level-3.png", "a.level-7.png", "a.off",
        "ab.seg", "a.parts.obj", "mine"}) {
    WriteFile(folder / name, "old");
  }
  WriteFile(folder / "a.json",
            Record(R"("a.seg", "a.level-3.seg", "a.level-3.png", "a.off",
                      "ab.seg", "mine", "gone", 7, "a.json")"));
  ASSERT_TRUE(PublishResults(folder.path(), "a",
                             {{"a.seg", "new"}, {"a.level-1.seg", "new"}})
                  .ok());
  EXPECT_THAT(ListFolder(folder.path()),
              ElementsAre("a.level-1.seg", "a.level-7.png", "a.off",
                          "a.parts.obj", "a.seg", "ab.seg", "mine"));
  EXPECT_EQ(ReadFile(folder / "a.seg"), "new");
  EXPECT_EQ(ReadFile(folder / "ab.seg"), "old");
}

TEST(ResultFolderTest, KnowsResultsWhoseNamesAreNoText) {
  const TemporaryFolder folder;
  WriteFile(folder / "a\xff.json", Record("\"a\\ufffd.level-3.seg\""));
  WriteFile(folder / "a\xff.level-3.seg", "old");
  ASSERT_TRUE(
      PublishResults(folder.path(), "a\xff", {{"a\xff.json", "new"}}).ok());
  EXPECT_THAT(ListFolder(folder.path()), ElementsAre("a\xff.json"));
}

TEST(ResultFolderTest, WhatNobodyListsIsLeftAlone) {
  for (const char* record :
       {"", "no JSON", "[]", R"({"files": ["a.parts.obj"]})",
        R"({"schema": "mine", "files": ["a.parts.obj"]})",
        R"({"schema": 1, "levels": [{"level": 7}]})"}) {
    const TemporaryFolder folder;
    WriteFile(folder / "a.json", record);
    WriteFile(folder / "a.parts.obj", "mine");
    WriteFile(folder / "a.level-7.png", "mine");
    ASSERT_TRUE(PublishResults(folder.path(), "a", {{"a.seg", "new"}}).ok());
    EXPECT_THAT(ListFolder(folder.path()),
                ElementsAre("a.json", "a.level-7.png", "a.parts.obj", "a.seg"))
        << record;
  }
}

// Before STEM.json listed files.
TEST(ResultFolderTest, KnowsWhatWasWrittenWithoutAList) {
  const TemporaryFolder folder;
  WriteFile(folder / "a.json", R"({"schema": "marrow.segmentation/1",
      "cut": {"segments": []}, "levels": [{"level": 1}, {"level": 2}]})");
  const std::string picture(
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x06\x40\0\0\x03\x20\x08\x02\0\0\0"
      "\xf4\xa2\x39\x0d\0\0\0\x01sRGB...",
      44);
  for (const char* name :
       {"a.level-1.png", "a.level-7.png", "a.cut.png", "b.cut.png"}) {
    WriteFile(folder / name, picture);
  }
  WriteFile(folder / "a.level-2.png", "\x89PNG, another's picture, though");
  WriteFile(folder / "a.level-2.ply", "old");
  WriteFile(folder / "a.level-3.ply", "mine");
  WriteFile(folder / "a.cut.parts.obj", "# One object a segment, by Marrow\n");
  WriteFile(folder / "a.parts.obj", "# One object a segment, by Marrow\no 1\n");
  ASSERT_TRUE(PublishResults(folder.path(), "a", {{"a.seg", "new"}}).ok());
  EXPECT_THAT(ListFolder(folder.path()),
              ElementsAre("a.cut.parts.obj", "a.level-2.png", "a.level-3.ply",
                          "a.level-7.png", "a.seg", "b.cut.png"));
}

TEST(ResultFolderTest, ACutReplacesAnEarlierCutAlone) {
  const TemporaryFolder folder;
  for (const char* name :
       {"a.seg", "a.level-1.seg", "a.cut.seg", "a.cut.png", "a.cut.ply"}) {
    WriteFile(folder / name, "old");
  }
  WriteFile(folder / "a.json",
            Record(R"("a.seg", "a.level-1.seg", "a.cut.ply", "a.json")"));
  WriteFile(folder / "a.cut.json",
            Record(R"("a.cut.seg", "a.cut.png")", "marrow.cut/1"));
  ASSERT_TRUE(PublishResults(folder.path(), "a",
                             {{"a.cut.seg", "new"}, {"a.cut.json", "new"}},
                             {.scope = ResultScope::kCut})
                  .ok());
  EXPECT_THAT(ListFolder(folder.path()),
              ElementsAre("a.cut.json", "a.cut.seg", "a.json", "a.level-1.seg",
                          "a.seg"));
  EXPECT_EQ(ReadFile(folder / "a.cut.seg"), "new");
}

TEST(ResultFolderTest, InputsStay) {
  const TemporaryFolder folder;
  WriteFile(folder / "a.json", Record(R"("a.level-2.ply", "a.level-3.ply")"));
  WriteFile(folder / "a.level-2.ply", "old");
  WriteFile(folder / "a.level-3.ply", "old");
  std::filesystem::create_symlink("a.level-3.ply", folder / "b.ply");
  const PublishOptions options{.inputs = {folder / "b.ply", "none.off"}};
  ASSERT_TRUE(
      PublishResults(folder.path(), "a", {{"a.seg", "new"}}, options).ok());
  EXPECT_THAT(ListFolder(folder.path()),
              ElementsAre("a.json", "a.level-3.ply", "a.seg", "b.ply"));
  const absl::Status status =
      PublishResults(folder.path(), "a", {{"a.level-3.ply", "new"}}, options);
  EXPECT_THAT(std::string(status.message()), HasSubstr("is an input"));
  EXPECT_EQ(ReadFile(folder / "b.ply"), "old");
}

// A folder stands where a file must go: all is as it was before.
TEST(ResultFolderTest, AfterAFailureTheOldResultsStand) {
  const TemporaryFolder folder;
  WriteFile(folder / "a.cut.json", Record(R"("a.level-3.seg")"));
  WriteFile(folder / "a.level-3.seg", "old");
  WriteFile(folder / "a.seg", "old");
  std::filesystem::create_directories(folder / "a.json/mine");
  const absl::Status status = PublishResults(
      folder.path(), "a",
      {{"a.seg", "new"}, {"a.level-1.seg", "new"}, {"a.json", "new"}});
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()), HasSubstr(folder / "a.json"));
  EXPECT_THAT(ListFolder(folder.path()),
              ElementsAre("a.cut.json", "a.json", "a.level-3.seg", "a.seg"));
  EXPECT_EQ(ReadFile(folder / "a.seg"), "old");
  EXPECT_TRUE(std::filesystem::exists(folder / "a.json/mine"));
}

TEST(ResultFolderTest, MakesFoldersAndRefusesWhatCannotBeOne) {
  const TemporaryFolder folder;
  EXPECT_THAT(PrepareFolder(folder / "x/y/z").value(),
              ElementsAre(folder / "x/y/z", folder / "x/y", folder / "x"));
  RemoveFolders({folder / "x/y/z"});
  EXPECT_THAT(PrepareFolder(folder / "x/y/").value(), IsEmpty());
  EXPECT_TRUE(ListFolder(folder / "x/y").empty());
  WriteFile(folder / "file", "");
  const absl::Status status = PrepareFolder(folder / "file").status();
  EXPECT_THAT(std::string(status.message()), HasSubstr("-o"));
  EXPECT_FALSE(PrepareFolder(folder / "file/z").ok());
}

TEST(ResultFolderTest, ALinkThatLeadsNowhereStays) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("nowhere", folder / "out");
  EXPECT_FALSE(PrepareFolder(folder / "out").ok());
  EXPECT_FALSE(PrepareFolder(folder / "out/x").ok());
  EXPECT_THAT(ListFolder(folder.path()), ElementsAre("out"));
}

// The process ends while others of its threads write.
TEST(StagingFolderTest, AProcessThatEndsLeavesNone) {
  const TemporaryFolder folder;
  const auto end = [&] {
    const StagingFolder staging = StagingFolder::Make(folder.path()).value();
    WriteFile((staging.path() / "a.seg").string(), "new");
    AbandonStaging(absl::Seconds(30));
    _exit(0);
  };
  EXPECT_EXIT(end(), ::testing::ExitedWithCode(0), "");
  EXPECT_THAT(ListFolder(folder.path()), IsEmpty());
}

TEST(StagingFolderTest, FilesThatMoveAreWaitedFor) {
  const TemporaryFolder folder;
  const auto end = [&] {
    const StagingFolder staging = StagingFolder::Make(folder.path()).value();
    std::filesystem::rename(folder / "a.seg", staging.path() / "a.seg");
    auto move = std::make_unique<FilesMove>();
    std::thread mover([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      std::filesystem::rename(staging.path() / "a.seg", folder / "a.seg");
      move.reset();
    });
    AbandonStaging(absl::Seconds(30));
    _exit(0);
  };
  WriteFile(folder / "a.seg", "old");
  EXPECT_EXIT(end(), ::testing::ExitedWithCode(0), "");
  EXPECT_THAT(ListFolder(folder.path()), ElementsAre("a.seg"));
}

}  // namespace
}  // namespace marrow::client
