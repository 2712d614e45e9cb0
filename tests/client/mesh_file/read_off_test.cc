#include <cmath>

#include "tests/client/mesh_file/matchers.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

TEST(ReadOffTest, ReadsPolygonsColoursAndComments) {
  const PolygonMesh mesh = ParseOrFail("m.off",
                                       "OFF # a comment\n"
                                       "# another\n"
                                       "4 3 0\n"
                                       "0 0 0\n"
                                       "1 0 0 255 0 0\n"
                                       "1 1 0\n"
                                       "\n"
                                       "0 1 0\n"
                                       "4 0 1 2 3 0.5 0.5 0.5\n"
                                       "3 2 1 0 255 0 0 255\n"
                                       "2 3 3\n");
  EXPECT_EQ(mesh.NumVertices(), 4u);
  EXPECT_THAT(mesh.positions[1], ElementsAre(1, 0, 0));
  EXPECT_THAT(Faces(mesh),
              ElementsAre(ElementsAre(0, 1, 2, 3), ElementsAre(2, 1, 0),
                          ElementsAre(3, 3)));
}

TEST(ReadOffTest, HasDoublesWhereFloatsSayLess) {
  const std::string rest = "1 0 0\n0 1 0\n3 0 1 2\n";
  const PolygonMesh floats =
      ParseOrFail("m.off", "OFF\n3 1 0\n0.1 0 0\n" + rest);
  EXPECT_EQ(floats.positions[0][0], 0.1f);
  const PolygonMesh doubles =
      ParseOrFail("m.off", "OFF\n3 1 0\n0.1 10000000.5 1e300\n" + rest);
  EXPECT_THAT(doubles.positions[0], ElementsAre(0.1, 10000000.5, 1e300));
}

TEST(ReadOffTest, ReadsItsVariants) {
  const std::string faces = "3 0 1 2\n";
  for (const std::string header : {"OFF 3 1 0\n", "3 1 0\n", "OFF\n3 1\n"}) {
    const PolygonMesh mesh =
        ParseOrFail("m.off", header + "0 0 0\n1 0 0\n0 1 0\n" + faces);
    EXPECT_THAT(Faces(mesh), ElementsAre(ElementsAre(0, 1, 2))) << header;
    EXPECT_THAT(mesh.positions[2], ElementsAre(0, 1, 0)) << header;
  }
  const std::string normals = "0 0 0 0 0 1\n1 0 0 0 0 1\n0 2 0 0 0 1\n";
  for (const std::string header : {"NOFF\n", "STCNOFF\n", "COFF\n"}) {
    const PolygonMesh mesh =
        ParseOrFail("m.off", header + "3 1 0\n" + normals + faces);
    EXPECT_THAT(mesh.positions[2], ElementsAre(0, 2, 0)) << header;
  }
  const PolygonMesh homogeneous =
      ParseOrFail("m.off", "4OFF\n3 1 0\n0 0 0 2\n2 0 0 2\n0 6 0 2\n" + faces);
  EXPECT_THAT(homogeneous.positions[2], ElementsAre(0, 3, 0));
}

TEST(ReadOffTest, ReadsCountsOnLinesOfTheirOwn) {
  const std::string rest = "5 5 5\n6 5 5\n5 6 5\n3 0 1 2\n";
  for (const std::string header :
       {"OFF\n3\n1\n0\n", "OFF 3\n1 0\n", "OFF\n3 1\n\n 0 # edges\n",
        "OFF\n3\n1\n", "3\n1\n0\n"}) {
    const PolygonMesh mesh = ParseOrFail("m.off", header + rest);
    EXPECT_THAT(mesh.positions,
                ElementsAre(ElementsAre(5, 5, 5), ElementsAre(6, 5, 5),
                            ElementsAre(5, 6, 5)))
        << header;
    EXPECT_THAT(Faces(mesh), ElementsAre(ElementsAre(0, 1, 2))) << header;
  }
}

// As Geomview takes them: vertices are numbers, whatever the lines.
TEST(ReadOffTest, ReadsVerticesWhateverTheirLines) {
  const std::string faces = "3 0 1 2\n3 0 2 3 255 0 0\n";
  for (const std::string vertices :
       {"OFF\n4 2 5\n0 0 0 1 0 0\n1 1 0 0 1 0\n",
        "OFF 4 2 5\n0 0 0 1 0 0 1 1 0 0 1 0\n",
        "OFF 4 2 5 0 0 0 1\n0 0 1 1 0\n0 1 0\n",
        "OFF\n4 2 5\n0\n0\n0\n1\n0\n0\n1\n1\n0\n0\n1\n0\n",
        "NOFF\n4 2 5\n0 0 0 0 0 1 1 0 0 0 0 1\n"
        "1 1 0 0 0 1 0 1 0 0 0 1\n",
        "C4OFF\n4 2 5\n0 0 0 1 1 0 0 1 1 0 0 1\n1 0 0 1\n"
        "1 1 0 1 1 0 0 1 0 1 0 1 1 0 0 1\n"}) {
    // The edges, which may follow, make as many lines as usual.
    for (const std::string rest : {"", "2 0 1\n2 1 2\n2 2 3\n2 3 0\n"}) {
      const PolygonMesh mesh = ParseOrFail("m.off", vertices + faces + rest);
      EXPECT_THAT(mesh.positions,
                  ElementsAre(ElementsAre(0, 0, 0), ElementsAre(1, 0, 0),
                              ElementsAre(1, 1, 0), ElementsAre(0, 1, 0)))
          << vertices << rest;
      EXPECT_THAT(Faces(mesh),
                  ElementsAre(ElementsAre(0, 1, 2), ElementsAre(0, 2, 3)))
          << vertices << rest;
    }
  }
}

TEST(ReadOffTest, ColoursAreNoVerticesWhateverFollows) {
  const std::string text =
      "4 2 0\n0 0 0 1 0 0\n1 0 0 1 0 0\n1 1 0 1 0 0\n0 1 0 1 0 0\n"
      "3 0 1 2\n3 0 2 3\n";
  for (const std::string header : {"OFF\n", "COFF\n", "NOFF\n"}) {
    for (const std::string rest : {"", "2 0 1\n2 1 2\n"}) {
      const PolygonMesh mesh = ParseOrFail("m.off", header + text + rest);
      EXPECT_THAT(mesh.positions[1], ElementsAre(1, 0, 0)) << header << rest;
      EXPECT_THAT(Faces(mesh)[1], ElementsAre(0, 2, 3)) << header << rest;
    }
  }
}

TEST(ReadOffTest, RefusesAVertexThatLacksANumber) {
  for (const std::string header : {"OFF\n4 1 0\n", "OFF\n4 1\n"}) {
    for (const std::string face : {"4 3 0 1 2\n", "3 0 1 2\n"}) {
      ExpectRefused("m.off", header + "0 0\n1 0 0\n0 1 0\n0 0 1\n" + face,
                    {"line 7", "0 of 1 faces", "cut off"});
    }
  }
}

TEST(ReadOffTest, ReadsNumbersThatAreNotFinite) {
  const PolygonMesh mesh =
      ParseOrFail("m.off", "OFF\n3 1 0\nnan 0 0\ninf 0 0\n0 -inf 0\n3 0 1 2\n");
  EXPECT_TRUE(std::isnan(mesh.positions[0][0]));
  EXPECT_TRUE(std::isinf(mesh.positions[1][0]));
  EXPECT_LT(mesh.positions[2][1], 0);
}

TEST(ReadOffTest, LeavesOutWhatFollowsTheFaces) {
  const std::string text = "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const char* rest : {"\n \n", "# 3 0 1 2\n", "0 1\n1 2\n2 0\n",
                           "2 0 1\n2 1 2\n", "3 0 1 9\n", "end\n"}) {
    EXPECT_EQ(ParseOrFail("m.off", text + rest).NumFaces(), 1u) << rest;
  }
}

TEST(ReadOffTest, ErrorsNameTheLineAndTheElement) {
  const std::string head = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  ExpectRefused("m.off", head + "3 0 1 2\n\n3 0 2 1 255 0 0\n3 2 1 0",
                {"line 8", "faces is 1, but", "has 3", "header"});
  ExpectRefused("m.off", head + "3 0 1 99\n",
                {"line 6", "vertex index 99 is out of range", "3 vertices"});
  ExpectRefused("m.off", head + "3 0 1 -1\n", {"line 6", "index -1"});
  ExpectRefused("m.off", head + "3 0 1 x\n", {"line 6", "face 0", "'x'"});
  ExpectRefused("m.off", head + "3 0 1\n", {"line 6", "not a vertex index"});
  ExpectRefused("m.off", head + "-3 0 1 2\n", {"line 6", "'-3'"});
  ExpectRefused("m.off", head, {"0 of 1 faces", "cut off"});
  ExpectRefused("m.off", "OFF\n3 1 0\n0 0 0\n", {"1 of 3 vertices"});
  ExpectRefused("m.off", "OFF\n3 1 0\n0 0 zero\n", {"line 3", "'zero'"});
  ExpectRefused("m.off", "OFF\n4000000000 1 0\n", {"vertices", "'4000000000'"});
  ExpectRefused("m.off", "OFF\n-1 1 0\n", {"line 2", "'-1'"});
  ExpectRefused("m.off", "OFF BINARY\n", {"save it as text"});
  ExpectRefused("m.off", "nOFF\n3 1 0\n", {"'nOFF'", "plain OFF"});
  ExpectRefused("m.off", "hello\n", {"line 1", "'hello'"});
  ExpectRefused("m.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", {"no faces"});
}

TEST(ReadOffTest, SurvivesDamage) {
  ExpectSurvivesDamage("m.off",
                       "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                       "3 0 1 2\n4 0 1 2 3 1 0 0\n");
}

}  // namespace
}  // namespace marrow
