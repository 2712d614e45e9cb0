#include "client/exporters/obj_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/client/exporters/meshes.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

using Positions = std::vector<std::array<double, 3>>;

struct ParsedObj {
  Positions vertices;
  std::vector<std::string> objects;
  std::map<std::string, std::vector<std::vector<size_t>>> faces;  // from 0
};

// Reads what a reader of floats, or one of doubles, would.
ParsedObj Parse(const std::string& text, bool floats = true) {
  ParsedObj obj;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "o") {
      words >> obj.objects.emplace_back();
    } else if (word == "v") {
      auto& vertex = obj.vertices.emplace_back();
      for (double& x : vertex) {
        words >> word;
        x = floats ? std::strtof(word.c_str(), nullptr)
                   : std::strtod(word.c_str(), nullptr);
      }
    } else if (word == "f") {
      auto& face = obj.faces[obj.objects.back()].emplace_back();
      for (size_t v = 0; words >> v;) face.push_back(v - 1);
    }
  }
  return obj;
}

Positions PositionsOf(const ParsedObj& obj, const std::vector<size_t>& face) {
  Positions positions;
  for (size_t v : face) positions.push_back(obj.vertices.at(v));
  return positions;
}

Positions PositionsOf(const PolygonMesh& mesh, size_t f) {
  Positions positions;
  for (uint32_t v : mesh.Face(f)) positions.push_back(mesh.positions[v]);
  return positions;
}

TEST(PartsObjFileTest, ObjectsPartitionTheFacesAndFloatsRoundTrip) {
  const auto [mesh, labels] = MakeStrip();
  ParsedObj obj = Parse(PartsObjFile(mesh, labels).value());
  EXPECT_THAT(obj.objects, ElementsAre("segment_2", "segment_7"));
  const auto& two = obj.faces["segment_2"];
  const auto& seven = obj.faces["segment_7"];
  ASSERT_EQ(two.size(), 2u);
  ASSERT_EQ(seven.size(), 2u);
  EXPECT_EQ(PositionsOf(obj, two[0]), PositionsOf(mesh, 1));
  EXPECT_EQ(PositionsOf(obj, two[1]), PositionsOf(mesh, 2));
  EXPECT_EQ(PositionsOf(obj, seven[0]), PositionsOf(mesh, 0));
  EXPECT_EQ(PositionsOf(obj, seven[1]), PositionsOf(mesh, 3));
}

TEST(PartsObjFileTest, DoublesRoundTripWhereThereAreSome) {
  auto [mesh, labels] = MakeStrip();
  mesh.positions[4] = {1e300, 0.1, -1e7 - 1e-7};
  ParsedObj obj = Parse(PartsObjFile(mesh, labels).value(), false);
  EXPECT_EQ(PositionsOf(obj, obj.faces["segment_7"][0]), PositionsOf(mesh, 0));
}

TEST(PartsObjFileTest, SharesVerticesWithinAnObjectOnly) {
  const auto [mesh, labels] = MakeStrip();
  ParsedObj obj = Parse(PartsObjFile(mesh, labels).value());
  std::map<std::string, std::set<size_t>> used;
  for (const auto& [name, faces] : obj.faces) {
    for (const auto& face : faces) used[name].insert(face.begin(), face.end());
  }
  EXPECT_EQ(used["segment_2"].size(), 4u);
  EXPECT_EQ(used["segment_7"].size(), 7u);
  EXPECT_EQ(obj.vertices.size(), 11u);  // so the two sets are disjoint
}

TEST(PartsObjFileTest, TakesAnEmptyMesh) {
  EXPECT_TRUE(Parse(PartsObjFile(PolygonMesh{}, {}).value()).objects.empty());
}

TEST(PartsObjFileTest, RefusesLabelsOfAnotherMesh) {
  EXPECT_EQ(PartsObjFile(MakeStrip().mesh, {}).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace marrow
