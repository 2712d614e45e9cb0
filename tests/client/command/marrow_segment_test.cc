// `marrow segment`, run as a person runs it, with the service in the process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <sstream>

#include "tests/client/command/segment_fixture.h"
#include "tests/testing/subprocess.h"

namespace marrow {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ListFolder;
using testing::ProgramPath;
using testing::ReadFile;
using testing::RunProgram;
using testing::TemporaryFolder;
using testing::WriteFile;

// The numbers after the counts of an OFF file without comments.
struct Off {
  std::vector<std::string> vertices;  // a line each
  std::vector<std::vector<uint32_t>> faces;
};

Off ParseOff(const std::string& text) {
  std::istringstream stream(text);
  std::string word;
  size_t vertices = 0;
  size_t faces = 0;
  stream >> word >> vertices >> faces >> word >> std::ws;
  Off off;
  off.vertices.resize(vertices);
  for (std::string& line : off.vertices) std::getline(stream, line);
  off.faces.resize(faces);
  for (auto& face : off.faces) {
    size_t corners = 0;
    stream >> corners;
    face.resize(corners);
    for (uint32_t& corner : face) stream >> corner;
  }
  return off;
}

std::string Format(const Off& off) {
  std::ostringstream text;
  text << "OFF\n" << off.vertices.size() << " " << off.faces.size() << " 0\n";
  for (const std::string& vertex : off.vertices) text << vertex << "\n";
  for (const auto& face : off.faces) {
    text << face.size();
    for (uint32_t corner : face) text << " " << corner;
    text << "\n";
  }
  return text.str();
}

TEST_F(MarrowSegmentTest, WritesEveryFileOfTheContract) {
  const Finished run = Segment({Sample(), "--levels", "2", "--png", "--parts"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty()) << "no progress where there is no terminal";
  EXPECT_THAT(run.out, HasSubstr("segments at level 1"));
  EXPECT_THAT(
      ListFolder(Out()),
      ElementsAre("octopus.cut.ply", "octopus.cut.png", "octopus.cut.seg",
                  "octopus.json", "octopus.level-1.ply", "octopus.level-1.png",
                  "octopus.level-1.seg", "octopus.level-2.ply",
                  "octopus.level-2.png", "octopus.level-2.seg",
                  "octopus.parts.obj", "octopus.seg"));
  EXPECT_EQ(ReadFile(Out("octopus.seg")), ReadFile(Out("octopus.level-2.seg")));
  EXPECT_EQ(ReadFile(Out("octopus.seg")), ReadFile(Out("octopus.cut.seg")));
  EXPECT_EQ(Lines(ReadFile(Out("octopus.seg"))).size(), 5000u);
}

TEST_F(MarrowSegmentTest, LabelsAreNodesOfTheTreeInTheJson) {
  ASSERT_EQ(Segment({Sample()}).code, 0);
  const json result = json::parse(ReadFile(Out("octopus.json")));
  std::map<uint32_t, json> nodes;
  for (const json& node : result["tree"]["nodes"]) nodes[node["id"]] = node;
  ASSERT_TRUE(nodes.contains(0));
  EXPECT_TRUE(nodes[0]["parent"].is_null());
  for (const auto& [id, node] : nodes) {
    for (uint32_t child : node["children"]) {
      EXPECT_EQ(nodes[child]["parent"], id);
    }
    EXPECT_EQ(node["children"].empty(), node["stop_reason"] != "") << id;
  }
  for (const std::string& line : Lines(ReadFile(Out("octopus.level-2.seg")))) {
    const uint32_t label = static_cast<uint32_t>(std::stoul(line));
    ASSERT_TRUE(nodes.contains(label));
    EXPECT_LE(nodes[label]["level"], 2);
  }
  EXPECT_EQ(result["skeletons"].size(), result["levels"].size());
  EXPECT_EQ(result["report"]["faces"], 5000);
  EXPECT_EQ(result["cache"]["outcome"], "miss");
}

TEST_F(MarrowSegmentTest, LevelsAreNested) {
  ASSERT_EQ(Segment({Sample()}).code, 0);
  const auto coarse = Lines(ReadFile(Out("octopus.level-1.seg")));
  const auto fine = Lines(ReadFile(Out("octopus.level-2.seg")));
  ASSERT_EQ(coarse.size(), fine.size());
  std::map<std::string, std::string> parent;
  for (size_t face = 0; face < fine.size(); ++face) {
    EXPECT_EQ(parent.emplace(fine[face], coarse[face]).first->second,
              coarse[face]);
  }
  EXPECT_GT(parent.size(), std::set(coarse.begin(), coarse.end()).size());
}

TEST_F(MarrowSegmentTest, FewerLevelsLeaveNothingOfADeeperRun) {
  ASSERT_EQ(Segment({Sample(), "--png", "--parts"}).code, 0);
  json listed = json::parse(ReadFile(Out("octopus.json")))["files"];
  std::sort(listed.begin(), listed.end());
  EXPECT_EQ(listed, json(ListFolder(Out())));
  WriteFile(Out("octopus.level-7.png"), "mine");
  ASSERT_EQ(Segment({Sample(), "--levels", "1"}).code, 0);
  WriteFile(Out("octopus.parts.obj"), "mine");
  ASSERT_EQ(Segment({Sample(), "--levels", "1"}).code, 0);
  EXPECT_THAT(
      ListFolder(Out()),
      ElementsAre("octopus.cut.ply", "octopus.cut.seg", "octopus.json",
                  "octopus.level-1.ply", "octopus.level-1.seg",
                  "octopus.level-7.png", "octopus.parts.obj", "octopus.seg"));
  EXPECT_EQ(ReadFile(Out("octopus.seg")), ReadFile(Out("octopus.cut.seg")));
}

TEST_F(MarrowSegmentTest, ARenumberedFileGetsTheSameLabelAFace) {
  const Off off = ParseOff(ReadFile(Sample()));
  Off turned;
  turned.vertices.assign(off.vertices.rbegin(), off.vertices.rend());
  turned.faces.assign(off.faces.rbegin(), off.faces.rend());
  const uint32_t last = static_cast<uint32_t>(off.vertices.size() - 1);
  for (auto& face : turned.faces) {
    for (uint32_t& corner : face) corner = last - corner;
    std::rotate(face.begin(), face.begin() + 1, face.end());
  }
  WriteFile(folder_ / "turned.off", Format(turned));
  ASSERT_EQ(Segment({Sample(), folder_ / "turned.off"}).code, 0);
  auto labels = Lines(ReadFile(Out("turned.seg")));
  std::reverse(labels.begin(), labels.end());
  EXPECT_EQ(labels, Lines(ReadFile(Out("octopus.seg"))));
}

// Faces 2f and 2f + 1 of a polygon file: pairs of triangles that share an edge
// become quads; the labels are one a polygon, in the polygons' order.
TEST_F(MarrowSegmentTest, PolygonsGetOneLabelEachInTheFilesOrder) {
  Off off = ParseOff(ReadFile(Sample()));
  std::vector<bool> used(off.faces.size(), false);
  std::map<std::pair<uint32_t, uint32_t>, size_t> face_of_edge;
  for (size_t f = 0; f < off.faces.size(); ++f) {
    for (size_t i = 0; i < 3; ++i) {
      face_of_edge[{off.faces[f][i], off.faces[f][(i + 1) % 3]}] = f;
    }
  }
  Off mixed{.vertices = off.vertices, .faces = {}};
  std::vector<size_t> triangle_of;  // of a polygon: one of its triangles
  for (size_t f = 0; f < off.faces.size(); ++f) {
    if (used[f]) continue;
    used[f] = true;
    const auto& t = off.faces[f];
    const size_t g = face_of_edge.at({t[1], t[0]});
    mixed.faces.push_back(t);
    triangle_of.push_back(f);
    if (used[g]) continue;
    used[g] = true;
    for (uint32_t corner : off.faces[g]) {
      if (corner != t[0] && corner != t[1]) {
        mixed.faces.back() = {t[0], corner, t[1], t[2]};
      }
    }
  }
  WriteFile(folder_ / "mixed.off", Format(mixed));
  ASSERT_EQ(Segment({Sample(), folder_ / "mixed.off"}).code, 0);
  const auto labels = Lines(ReadFile(Out("mixed.level-1.seg")));
  const auto expected = Lines(ReadFile(Out("octopus.level-1.seg")));
  ASSERT_EQ(labels.size(), mixed.faces.size());
  // The diagonals differ, and with them the operator a little; the parts
  // are the same.
  std::map<std::pair<std::string, std::string>, size_t> agree;
  for (size_t f = 0; f < labels.size(); ++f) {
    ++agree[{labels[f], expected[triangle_of[f]]}];
  }
  std::map<std::string, size_t> best;
  for (const auto& [pair, count] : agree) {
    best[pair.first] = std::max(best[pair.first], count);
  }
  const size_t same = std::accumulate(
      best.begin(), best.end(), size_t{0},
      [](size_t sum, const auto& entry) { return sum + entry.second; });
  EXPECT_GT(best.size(), 1u);
  EXPECT_GT(static_cast<double>(same),
            .95 * static_cast<double>(labels.size()));
}

TEST_F(MarrowSegmentTest, OneFileFailsAndTheOthersAreDone) {
  WriteFile(folder_ / "bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n");
  WriteFile(folder_ / "empty.obj", "");
  const Finished run = Segment({folder_ / "bad.off", folder_ / "missing.off",
                                Sample(), folder_ / "empty.obj"});
  EXPECT_EQ(run.code, 1);
  for (const char* name : {"bad.off", "missing.off", "empty.obj"}) {
    EXPECT_THAT(run.err, HasSubstr(folder_ / name));
  }
  EXPECT_THAT(run.out, HasSubstr("4 files: 1 segmented, 3 failed"));
  EXPECT_THAT(ListFolder(Out()), ::testing::Contains("octopus.seg"));
  for (const std::string& name : ListFolder(Out())) {
    EXPECT_TRUE(name.starts_with("octopus.")) << name;
  }
}

TEST_F(MarrowSegmentTest, ImpossibleParametersNameTheOptionAndLeaveNothing) {
  const std::vector<std::array<std::string, 2>> cases = {
      {"--kappa", "-1"},       {"--kappa", "nan"},   {"--pairs", "0"},
      {"--pairs", "1001"},     {"--delta", "1"},     {"--epsilon", "2"},
      {"--tolerance", "9"},    {"--levels", "0"},    {"--levels", "9"},
      {"--pairs", "x"},        {"--timeout", "0"},   {"--quantize", "25"},
      {"--method", "guess"},   {"--cut", "level:4"}, {"--cut", "segments:0"},
      {"--cut", "salience:2"}, {"--cut", "half"},    {"--open", "x"},
      {"--closed", "x"}};
  for (const auto& [option, value] : cases) {
    const Finished run = Segment({Sample(), option, value});
    EXPECT_EQ(run.code, 2) << option << " " << value << run.err;
    EXPECT_THAT(run.err, HasSubstr(option)) << value;
    EXPECT_FALSE(std::filesystem::exists(Out())) << option;
  }
}

TEST_F(MarrowSegmentTest, TheMethodIsTheCallersChoice) {
  const Finished run = Segment({Sample(), "--method", "merge"});
  ASSERT_EQ(run.code, 0) << run.err;
  const json answer = json::parse(ReadFile(Out() + "/octopus.json"));
  EXPECT_GT(answer["tree"]["nodes"][0]["salience"], 0);
}

TEST_F(MarrowSegmentTest, TheCutIsTheCallersChoice) {
  const auto cut_by = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {Sample(), "--method", "merge",
                                          "--pairs", "40"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Finished run = Segment(arguments);
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr(" in the cut"));
    const auto lines = Lines(ReadFile(Out("octopus.cut.seg")));
    const json cut = json::parse(ReadFile(Out("octopus.json")))["cut"];
    std::set<std::string> ids;
    for (const json& segment : cut["segments"]) {
      ids.insert(segment["id"].dump());
    }
    EXPECT_EQ(std::set(lines.begin(), lines.end()), ids);
    EXPECT_EQ(ids.size(), cut["number"]);
    return cut;
  };
  EXPECT_LE(cut_by({"--cut", "segments:4"})["number"], 4);
  EXPECT_EQ(cut_by({"--cut", "segments:1"})["number"], 1);
  const json by_salience = cut_by({"--cut", "salience:0.125"});
  EXPECT_EQ(by_salience["salience"], 0.125);
  EXPECT_EQ(by_salience["spec"], "salience:0.125");
  cut_by({"--cut", "level:1"});
  EXPECT_EQ(ReadFile(Out("octopus.cut.seg")),
            ReadFile(Out("octopus.level-1.seg")));
  EXPECT_EQ(cut_by({"--cut", "level:3", "--closed", "0"})["number"], 1);
  const json open = cut_by({"--cut", "segments:1", "--open", "0,0"});
  EXPECT_GT(open["number"], 1);
  EXPECT_EQ(open["open"], json::parse("[0,0]"));
}

TEST_F(MarrowSegmentTest, OptionsOfNodesStandAnywhere) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--closed", "1,2", "--closed", "3", Sample()},
        {Sample(), "--closed", "1,2", "--closed", "3"},
        {"--closed", "1,2,3", Sample()}}) {
    const Finished run = Segment(arguments);
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(json::parse(ReadFile(Out("octopus.json")))["cut"]["closed"],
              json::parse("[1,2,3]"));
  }
}

TEST_F(MarrowSegmentTest, ANodeThatOneMeshLacksIsThatFilesFailure) {
  WriteFile(folder_ / "one.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  for (const char* option : {"--closed", "--open"}) {
    const Finished run =
        Segment({folder_ / "one.off", Sample(), "--threads", "1", option, "1"});
    EXPECT_EQ(run.code, 1);
    EXPECT_THAT(run.err, HasSubstr("one.off: " + std::string(option) +
                                   " is 1; the tree has the nodes 0 to 0"));
    EXPECT_THAT(run.out, HasSubstr("1 segmented, 1 failed"));
  }
}

TEST_F(MarrowSegmentTest, ANodeBothOpenAndClosedIsAUsageError) {
  const Finished run = Segment({"--open", "1", "--closed", "2,1", Sample()});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("--open: is 1, and so is --closed"));
}

TEST_F(MarrowSegmentTest, WithoutAServerACutIsMadeAnew) {
  const Finished run =
      RunProgram({ProgramPath("marrow"), "cut", Sample(), "-o", Out(), "--cut",
                  "segments:5", "--png", "--parts", "--pairs", "40"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("made anew"));
  EXPECT_THAT(
      ListFolder(Out()),
      ElementsAre("octopus.cut.json", "octopus.cut.parts.obj",
                  "octopus.cut.ply", "octopus.cut.png", "octopus.cut.seg"));
  const json result = json::parse(ReadFile(Out("octopus.cut.json")));
  EXPECT_LE(result["cut"]["number"], 5);
  EXPECT_EQ(result["schema"], "marrow.cut/1");
}

TEST_F(MarrowSegmentTest, TwoInputsWithOneStemAreRefusedBeforeAnyWork) {
  const Finished run = Segment({folder_ / "octopus.ply", Sample()});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("same files"));
  EXPECT_FALSE(std::filesystem::exists(Out()));
}

TEST_F(MarrowSegmentTest, TheFolderMustBeOne) {
  WriteFile(Out(), "a file");
  const Finished run = Segment({Sample()});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr(Out()));
  EXPECT_EQ(ReadFile(Out()), "a file");
}

TEST_F(MarrowSegmentTest, AFailedWriteLeavesTheEarlierResults) {
  ASSERT_EQ(Segment({Sample(), "--levels", "1"}).code, 0);
  const std::string before = ReadFile(Out("octopus.json"));
  std::filesystem::create_directories(Out("octopus.level-2.ply/x"));
  const auto names = ListFolder(Out());
  const Finished run = Segment({Sample()});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("octopus.level-2.ply"));
  EXPECT_EQ(ListFolder(Out()), names);
  EXPECT_EQ(ReadFile(Out("octopus.json")), before);
}

TEST_F(MarrowSegmentTest, JsonIsALineAnEventInOrder) {
  const Finished run = Segment({Sample(), "--json", "--levels", "2"});
  ASSERT_EQ(run.code, 0) << run.err;
  std::vector<std::string> names;
  for (const std::string& line : Lines(run.out)) {
    const json event = json::parse(line);
    if (event["event"] == "progress") continue;
    names.push_back(event["event"]);
    if (event["event"] == "completed") {
      for (const std::string output : event["outputs"]) {
        EXPECT_TRUE(std::filesystem::exists(output)) << output;
      }
    }
  }
  EXPECT_THAT(names, ElementsAre("accepted", "mesh_report", "level", "skeleton",
                                 "level", "skeleton", "cut", "skeleton",
                                 "completed", "summary"));
}

TEST_F(MarrowSegmentTest, OnATerminalJsonStandsWithoutABar) {
  const Finished run =
      RunProgram({"/usr/bin/script", "-qec",
                  ProgramPath("marrow") + " segment --json --levels 1 -o " +
                      Out() + " " + Sample(),
                  "/dev/null"});
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.out, HasSubstr("\"progress\""));
  for (const std::string& line : Lines(run.out)) {
    EXPECT_TRUE(line.starts_with('{')) << line;
  }
}

TEST_F(MarrowSegmentTest, SeveralFilesAreToldInTheirOrder) {
  std::vector<std::string> arguments = {"--levels", "1", "--threads", "3"};
  const std::string tetrahedron =
      "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
      "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  arguments.push_back(Sample());  // the slowest
  for (const char* name : {"d.off", "c.off", "b.off", "a.off"}) {
    WriteFile(folder_ / name, tetrahedron);
    arguments.push_back(folder_ / name);
  }
  const Finished run = Segment(arguments);
  ASSERT_EQ(run.code, 0) << run.err;
  const std::vector<std::string> lines = Lines(run.out);
  ASSERT_EQ(lines.size(), 6u);
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(lines[i].starts_with(arguments[4 + i])) << lines[i];
  }
}

TEST_F(MarrowSegmentTest, QuietTellsNothing) {
  const Finished run = Segment({Sample(), "--quiet", "--levels", "1"});
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.out, IsEmpty());
  EXPECT_THAT(run.err, IsEmpty());
}

TEST_F(MarrowSegmentTest, AnOptionOfTheOtherMethodIsWarnedOf) {
  const std::string mesh = folder_ / "one.off";
  WriteFile(mesh, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const std::string warning =
      "marrow: warning: --kappa has no effect with --method merge\n";
  EXPECT_EQ(Segment({mesh, "--kappa", "2", "--method", "merge"}).err, warning);
  EXPECT_EQ(Segment({mesh, "--kappa", "2"}).err, warning);
  EXPECT_EQ(Segment({mesh, "--kappa", "2", "--quiet"}).err, "");
  EXPECT_EQ(Segment({mesh, "--kappa", "2", "--method", "paper"}).err, "");
  EXPECT_EQ(Segment({mesh, "--delta", "0.2", "--epsilon", "0.02"}).err, "");
}

TEST_F(MarrowSegmentTest, ASingleTriangleIsOneSegment) {
  WriteFile(folder_ / "one.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Finished run = Segment({folder_ / "one.off"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("1 segment at level 1"));
  EXPECT_EQ(ReadFile(Out("one.seg")), "0\n");
}

TEST_F(MarrowSegmentTest, WarningsAreToldAndKept) {
  WriteFile(folder_ / "two.off",
            "OFF\n8 5 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n9 0 0\n9 1 0\n9 0 1\n"
            "5 5 5\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 4 5 6\n");
  const Finished run = Segment({folder_ / "two.off"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("two.off: warning: 1 vertex is in no face"));
  EXPECT_THAT(run.err, HasSubstr("two.off: warning: the mesh is 2 bodies"));
  const json result = json::parse(ReadFile(Out("two.json")));
  std::vector<std::string> codes;
  for (const json& warning : result["report"]["warnings"]) {
    codes.push_back(warning["code"]);
    EXPECT_FALSE(warning["message"].get<std::string>().empty());
  }
  EXPECT_THAT(codes, ElementsAre("UNUSED_POINTS", "SEVERAL_BODIES"));
  EXPECT_EQ(result["report"]["unused_points"], 1);

  const Finished events = Segment({folder_ / "two.off", "--json", "--quiet"});
  EXPECT_THAT(events.out, HasSubstr("\"event\":\"warning\""));
  EXPECT_THAT(events.err, IsEmpty());
}

}  // namespace
}  // namespace marrow
