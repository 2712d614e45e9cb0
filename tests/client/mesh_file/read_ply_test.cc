#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "tests/client/mesh_file/matchers.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

template <typename T>
void Append(T value, bool big_endian, std::string* out) {
  std::string raw(reinterpret_cast<const char*>(&value), sizeof(value));
  if (big_endian) std::reverse(raw.begin(), raw.end());
  *out += raw;
}

// Two faces, a triangle and a quad, among properties that are to be skipped.
std::string BinaryPly(bool big_endian) {
  std::string out = std::string("ply\nformat binary_") +
                    (big_endian ? "big" : "little") +
                    "_endian 1.0\ncomment end_header is not here\n"
                    "element vertex 4\nproperty uchar red\n"
                    "property double x\nproperty float y\nproperty short z\n"
                    "property list uchar short extra\n"
                    "element edge 1\nproperty int a\n"
                    "element face 2\nproperty list uchar float texcoord\n"
                    "property list ushort uint vertex_index\n"
                    "property uchar flag\nend_header\n";
  for (int v = 0; v < 4; ++v) {
    Append(uint8_t{10}, big_endian, &out);
    Append(v + 0.1, big_endian, &out);
    Append(-0.0f, big_endian, &out);
    Append(static_cast<int16_t>(-v), big_endian, &out);
    Append(uint8_t{1}, big_endian, &out);
    Append(int16_t{7}, big_endian, &out);
  }
  Append(int32_t{10}, big_endian, &out);
  for (const uint16_t corners : {3, 4}) {
    Append(uint8_t{2}, big_endian, &out);
    Append(0.5f, big_endian, &out);
    Append(0.5f, big_endian, &out);
    Append(corners, big_endian, &out);
    for (uint32_t i = 0; i < corners; ++i) Append(i, big_endian, &out);
    Append(uint8_t{1}, big_endian, &out);
  }
  return out;
}

constexpr char kHeader[] =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
    "property float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";

TEST(ReadPlyTest, ReadsText) {
  const PolygonMesh mesh =
      ParseOrFail("m.ply", std::string(kHeader) +
                               "0.1 nan -0\n1 inf 16777217\n0 1 0\n3 2 1 0\n");
  EXPECT_EQ(mesh.positions[0][0], 0.1f);
  EXPECT_TRUE(std::isnan(mesh.positions[0][1]));
  EXPECT_TRUE(std::signbit(mesh.positions[0][2]));
  EXPECT_EQ(mesh.positions[1][2], 16777216.0f);
  EXPECT_THAT(Faces(mesh), ElementsAre(ElementsAre(2, 1, 0)));
}

TEST(ReadPlyTest, ReadsBinaryOfEitherEndSkippingWhatItDoesNotKnow) {
  for (const bool big_endian : {false, true}) {
    const PolygonMesh mesh = ParseOrFail("m.ply", BinaryPly(big_endian));
    ASSERT_EQ(mesh.NumVertices(), 4u);
    EXPECT_THAT(mesh.positions[2], ElementsAre(2.1, 0, -2));
    EXPECT_TRUE(std::signbit(mesh.positions[2][1]));
    EXPECT_THAT(Faces(mesh),
                ElementsAre(ElementsAre(0, 1, 2), ElementsAre(0, 1, 2, 3)));
  }
}

TEST(ReadPlyTest, ReadsHeadersWithCarriageReturns) {
  const std::string bytes = BinaryPly(false);
  const size_t data = bytes.find("flag\nend_header\n") + 16;
  std::string header;
  for (const char c : bytes.substr(0, data)) {
    if (c == '\n') header += '\r';
    header += c;
  }
  EXPECT_EQ(ParseOrFail("m.ply", header + bytes.substr(data)).NumFaces(), 2u);
}

TEST(ReadPlyTest, LeavesOutPadding) {
  for (const std::string& rest :
       {std::string("\n"), std::string(3, '\0'), std::string(90, '\0')}) {
    EXPECT_EQ(ParseOrFail("m.ply", BinaryPly(false) + rest).NumFaces(), 2u);
  }
  const std::string text = std::string(kHeader) + "0 0 0\n1 0 0\n0 1 0\n";
  for (const char* rest : {"\n \n", "end\n", "2 0 1\n", "3 0 1 9\n"}) {
    const PolygonMesh mesh = ParseOrFail("m.ply", text + "3 2 1 0\n" + rest);
    EXPECT_THAT(Faces(mesh), ElementsAre(ElementsAre(2, 1, 0))) << rest;
  }
}

TEST(ReadPlyTest, MoreFacesThanTheHeaderSaysAreAnError) {
  ExpectRefused(
      "m.ply",
      std::string(kHeader) + "0 0 0\n1 0 0\n0 1 0\n3 2 1 0\n3 0 1 2\n3 1 0 2\n",
      {"faces is 1, but", "has 3", "header"});
  std::string binary = BinaryPly(false);
  binary.replace(binary.find("face 2"), 6, "face 1");
  ExpectRefused("m.ply", binary, {"faces is 1, but", "has 2"});
}

TEST(ReadPlyTest, ErrorsNameTheElement) {
  const std::string head = kHeader;
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  ExpectRefused("m.ply", head + points + "3 0 1 3\n",
                {"face 0", "vertex index 3 is out of range", "3 vertices"});
  ExpectRefused("m.ply", head + points + "3 0 1 -1\n", {"line 13", "index -1"});
  ExpectRefused("m.ply", head + points + "3 0 1\n", {"line 13", "face 0"});
  ExpectRefused("m.ply", head + points, {"0 of 1 elements 'face'"});
  ExpectRefused("m.ply", head + "0 0 zero\n", {"line 10", "vertex 0"});
  ExpectRefused("m.ply", "plx\n", {"line 1", "'ply'"});
  ExpectRefused("m.ply", "ply\nformat ascii 1.0\n", {"end_header"});
  ExpectRefused("m.ply", "ply\nformat utf9 1.0\n", {"line 2", "'utf9'"});
  ExpectRefused("m.ply", "ply\nformat ascii 1.0\nelement vertex 5000000000\n",
                {"line 3", "'5000000000'"});
  ExpectRefused("m.ply",
                "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"
                "property float y\nproperty float z\nend_header\n",
                {"vertex_indices"});
  const std::string binary = BinaryPly(false);
  ExpectRefused("m.ply", binary.substr(0, binary.size() - 3),
                {"byte", "face 1", "cut off"});
}

TEST(ReadPlyTest, SurvivesDamage) {
  ExpectSurvivesDamage("m.ply",
                       std::string(kHeader) + "0 0 0\n1 0 0\n0 1 0\n3 2 1 0\n");
  ExpectSurvivesDamage("m.ply", BinaryPly(false));
}

}  // namespace
}  // namespace marrow
