#include <cstdint>
#include <cstring>
#include <string>

#include "tests/client/mesh_file/matchers.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

std::string BinaryStl(uint32_t declared, int triangles,
                      const std::string& header) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&declared), 4);
  for (int t = 0; t < triangles; ++t) {
    std::string record(50, '\0');
    for (int i = 3; i < 12; ++i) {
      const float value = static_cast<float>(100 * t + i);
      std::memcpy(&record[4 * i], &value, 4);
    }
    bytes += record;
  }
  return bytes;
}

constexpr char kText[] =
    "solid a vertex facet\n facet normal 0 0 1\n  outer loop\n"
    "   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1e0 0\n"
    "  endloop\n endfacet\nFACET NORMAL 0 0 1\n  OUTER LOOP\n"
    "   VERTEX 0 0 0\n   VERTEX 0 0 0\n   VERTEX 0 0 0\n"
    "  ENDLOOP\n ENDFACET\nendsolid a\n";

TEST(ReadStlTest, ReadsText) {
  const PolygonMesh mesh = ParseOrFail("m.stl", kText);
  EXPECT_EQ(mesh.NumVertices(), 6u);
  EXPECT_THAT(Faces(mesh),
              ElementsAre(ElementsAre(0, 1, 2), ElementsAre(3, 4, 5)));
  EXPECT_THAT(mesh.positions[2], ElementsAre(0, 1, 0));
}

TEST(ReadStlTest, ReadsSeveralSolids) {
  EXPECT_EQ(ParseOrFail("m.stl", std::string(kText) + kText).NumFaces(), 4u);
}

TEST(ReadStlTest, ReadsBinaryWhateverItsHeaderSays) {
  for (const char* header : {"", "solid but binary", "COLOR=abcd"}) {
    const PolygonMesh mesh = ParseOrFail("m.stl", BinaryStl(2, 2, header));
    EXPECT_THAT(Faces(mesh),
                ElementsAre(ElementsAre(0, 1, 2), ElementsAre(3, 4, 5)));
    EXPECT_THAT(mesh.positions[0], ElementsAre(3, 4, 5));
    EXPECT_THAT(mesh.positions[5], ElementsAre(109, 110, 111));
  }
}

TEST(ReadStlTest, LeavesOutPadding) {
  for (const size_t padding : {1, 49}) {
    const std::string bytes = BinaryStl(2, 2, "") + std::string(padding, '\0');
    EXPECT_EQ(ParseOrFail("m.stl", bytes).NumFaces(), 2u);
  }
}

TEST(ReadStlTest, ErrorsSayWhatIsWrong) {
  ExpectRefused("m.stl", BinaryStl(1, 3, ""),
                {"byte 80", "triangles is 1, but", "room for 3", "export"});
  ExpectRefused("m.stl", BinaryStl(0xFFFFFFFF, 2, ""),
                {"byte 80", "4294967295 triangles", "184", "cut off"});
  ExpectRefused("m.stl", "short", {"5 bytes", "'solid'"});
  ExpectRefused("m.stl", BinaryStl(0, 0, ""), {"no faces"});
  ExpectRefused("m.stl", "solid x\nfacet normal 0 0 1\nvertex 0 0\n",
                {"line 3", "not a coordinate"});
  ExpectRefused("m.stl", "solid x\nfacet normal 0 0 1\nvertex 0 0 0\n",
                {"line 3", "endfacet"});
}

TEST(ReadStlTest, SurvivesDamage) {
  ExpectSurvivesDamage("m.stl", kText);
  ExpectSurvivesDamage("m.stl", BinaryStl(2, 2, ""));
}

}  // namespace
}  // namespace marrow
