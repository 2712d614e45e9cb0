#include "client/exporters/json_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/client/exporters/meshes.h"

namespace marrow {
namespace {

using client::Level;
using client::Point3;
using client::Segmentation;
using client::SegmentNode;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

Segmentation MakeSegmentation() {
  Segmentation segmentation;
  segmentation.nodes.resize(3);
  SegmentNode& root = segmentation.nodes[0];
  root.children = {1, 2};
  root.area = 0.1 + 0.2;
  root.centroid = {1.0 / 3, -1e-300, 2};
  root.medial_structure = {4, 5};
  root.iterations = 3;
  root.salience = 0.75;
  for (uint32_t id : {1u, 2u}) {
    segmentation.nodes[id].id = id;
    segmentation.nodes[id].parent = 0;
    segmentation.nodes[id].level = 1;
    segmentation.nodes[id].stop_reason = "depth";
  }
  Level level;
  level.level = 1;
  level.face_labels = {2, 1, 2, 2, 1};
  level.skeleton.joints = {
      {.id = 0, .position = {1, 2, 3}, .segments = {1}},
      {.id = 1, .parent = 0, .articulation = true, .segments = {1, 2}},
      {.id = 2, .parent = 1, .segments = {2}}};
  segmentation.levels.push_back(level);
  segmentation.report = {{"shells", 1}};
  segmentation.timings = {{"solve", 0.25}};
  segmentation.cache = {{"hit", false}};
  return segmentation;
}

std::string Write(const Segmentation& segmentation) {
  return JsonFile("strip.obj", MakeStrip().mesh, segmentation);
}

TEST(JsonFileTest, HasTheDocumentedKeysInOrder) {
  const Json root = Json::parse(Write(MakeSegmentation()));
  std::vector<std::string> keys;
  for (const auto& [key, value] : root.items()) keys.push_back(key);
  EXPECT_THAT(
      keys, testing::ElementsAre("schema", "files", "mesh", "tree",
                                 "automatic_cut", "cut", "levels", "skeletons",
                                 "report", "timings", "cache"));
  EXPECT_TRUE(root["cut"].is_null());
  EXPECT_EQ(root["schema"], "marrow.segmentation/1");
  EXPECT_EQ(root["mesh"], Json::parse(R"({"name": "strip.obj",
                                          "vertices": 8, "faces": 5})"));
  EXPECT_EQ(root["automatic_cut"]["level"], 1);
  EXPECT_EQ(root["report"]["shells"], 1);
  EXPECT_EQ(root["timings"]["solve"], 0.25);
  EXPECT_EQ(root["cache"]["hit"], false);
}

TEST(JsonFileTest, WritesTheTree) {
  const Json nodes = Json::parse(Write(MakeSegmentation()))["tree"]["nodes"];
  ASSERT_EQ(nodes.size(), 3u);
  EXPECT_EQ(nodes[1], Json::parse(R"({
      "id": 1, "parent": 0, "children": [], "level": 1, "area": 0.0,
      "centroid": [0.0, 0.0, 0.0], "medial_structure": [], "salience": 0.0,
      "iterations": 0,
      "stop_reason": "depth"})"));
  EXPECT_TRUE(nodes[0]["parent"].is_null());
  EXPECT_EQ(nodes[0]["children"], Json({1, 2}));
  EXPECT_EQ(nodes[0]["medial_structure"], Json({4, 5}));
  EXPECT_EQ(nodes[0]["iterations"], 3);
  EXPECT_EQ(nodes[0]["salience"], 0.75);
  EXPECT_EQ(nodes[0]["stop_reason"], "");
}

TEST(JsonFileTest, NumbersRoundTrip) {
  const Segmentation segmentation = MakeSegmentation();
  const Json root = Json::parse(Write(segmentation));
  const Json& node = root["tree"]["nodes"][0];
  EXPECT_EQ(node["area"].get<double>(), segmentation.nodes[0].area);
  EXPECT_EQ(node["centroid"].get<Point3>(), segmentation.nodes[0].centroid);
}

TEST(JsonFileTest, WritesLevelsWithFaceCounts) {
  const Json root = Json::parse(Write(MakeSegmentation()));
  EXPECT_EQ(root["levels"], Json::parse(R"([{"level": 1, "segments": [
      {"id": 1, "faces": 2}, {"id": 2, "faces": 3}]}])"));
}

TEST(JsonFileTest, WritesSkeletons) {
  const Json root = Json::parse(Write(MakeSegmentation()));
  EXPECT_EQ(root["skeletons"], Json::parse(R"([{"level": 1, "joints": [
      {"id": 0, "parent": null, "kind": "segment",
       "position": [1.0, 2.0, 3.0], "segments": [1]},
      {"id": 1, "parent": 0, "kind": "articulation",
       "position": [0.0, 0.0, 0.0], "segments": [1, 2]},
      {"id": 2, "parent": 1, "kind": "segment",
       "position": [0.0, 0.0, 0.0], "segments": [2]}],
      "bones": [{"from": 0, "to": 1}, {"from": 1, "to": 2}]}])"));
}

client::Cut MakeCut() {
  client::Cut cut;
  cut.segments.resize(2);
  cut.segments[0].id = 2;
  SegmentNode& other = cut.segments[1];
  other.id = 9;
  other.parent = 1;
  other.level = 2;
  other.area = 4;
  other.centroid = {1, 2, 3};
  other.medial_structure = {5};
  other.salience = 0.5;
  cut.salience = 0.625;
  cut.level.face_labels = {9, 9, 2, 9, 2};
  cut.level.skeleton.joints = {{.id = 0, .segments = {2}},
                               {.id = 1, .parent = 0, .segments = {9}}};
  return cut;
}

TEST(JsonFileTest, WritesTheCut) {
  Segmentation segmentation = MakeSegmentation();
  segmentation.cut = MakeCut();
  const CutNote asked = {"segments:2", {4}, {0, 1}};
  const Json cut = Json::parse(
      JsonFile("strip.obj", MakeStrip().mesh, segmentation, asked))["cut"];
  EXPECT_EQ(cut["spec"], "segments:2");
  EXPECT_EQ(cut["closed"], Json({4}));
  EXPECT_EQ(cut["open"], Json({0, 1}));
  EXPECT_EQ(cut["number"], 2);
  EXPECT_EQ(cut["salience"], 0.625);
  EXPECT_EQ(cut["segments"][0]["faces"], 2);
  EXPECT_TRUE(cut["segments"][0]["parent"].is_null());
  EXPECT_EQ(cut["segments"][1], Json::parse(R"({
      "id": 9, "faces": 3, "parent": 1, "level": 2, "area": 4.0,
      "centroid": [1.0, 2.0, 3.0], "medial_structure": [5],
      "salience": 0.5})"));
  EXPECT_EQ(cut["skeleton"]["joints"].size(), 2u);
  EXPECT_EQ(cut["skeleton"]["bones"], Json::parse(R"([{"from": 0, "to": 1}])"));
  EXPECT_FALSE(cut["skeleton"].contains("level"));

  const Json alone = Json::parse(
      CutJsonFile("strip.obj", MakeStrip().mesh,
                  {MakeCut(), {{"total", 1}}, {{"result", "hit"}}}, asked));
  EXPECT_EQ(alone["schema"], "marrow.cut/1");
  EXPECT_TRUE(alone["files"].empty());
  EXPECT_EQ(alone["mesh"]["faces"], 5);
  EXPECT_EQ(alone["cut"], cut);
  EXPECT_EQ(alone["cache"]["result"], "hit");
}

TEST(JsonFileTest, LongListsStayOnALine) {
  Segmentation segmentation = MakeSegmentation();
  segmentation.nodes[0].medial_structure = {1, 2, 3, 4};
  EXPECT_THAT(Write(segmentation),
              HasSubstr("\"medial_structure\": [1,2,3,4],\n"));
}

TEST(JsonFileTest, ReplacesWhatJsonCannotHold) {
  Segmentation segmentation = MakeSegmentation();
  segmentation.nodes[0].area = std::numeric_limits<double>::quiet_NaN();
  segmentation.report = {{"bad \xFF key", "bad \xC0 value"}};
  const Json root =
      Json::parse(JsonFile("\xFE.obj", MakeStrip().mesh, segmentation));
  EXPECT_EQ(root["mesh"]["name"], "\xEF\xBF\xBD.obj");
  EXPECT_TRUE(root["tree"]["nodes"][0]["area"].is_null());
  EXPECT_EQ(root["report"]["bad \xEF\xBF\xBD key"], "bad \xEF\xBF\xBD value");
}

}  // namespace
}  // namespace marrow
