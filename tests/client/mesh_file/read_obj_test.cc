#include <cmath>

#include "tests/client/mesh_file/matchers.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

constexpr char kTetrahedron[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TEST(ReadObjTest, KeepsTheOrderOfFacesAcrossGroupsAndMaterials) {
  const PolygonMesh mesh = ParseOrFail("m.obj", std::string(kTetrahedron) +
                                                    "usemtl a\nf 1 2 3\n"
                                                    "usemtl b\nf 2 3 4\n"
                                                    "g part\nusemtl a\n"
                                                    "f 1 2 4\no other\n"
                                                    "f 1 3 4\n");
  EXPECT_THAT(Faces(mesh),
              ElementsAre(ElementsAre(0, 1, 2), ElementsAre(1, 2, 3),
                          ElementsAre(0, 1, 3), ElementsAre(0, 2, 3)));
}

TEST(ReadObjTest, HasDoublesWhereFloatsSayLess) {
  const std::string rest = "v 0 1 0\nv 0 0 1\nf 1 2 3\n";
  EXPECT_EQ(ParseOrFail("m.obj", "v 0.1 0 0\n" + rest).positions[0][0], 0.1f);
  EXPECT_THAT(ParseOrFail("m.obj", "v 0.1 0 1e-50\n" + rest).positions[0],
              ElementsAre(0.1, 0, 1e-50));
}

TEST(ReadObjTest, EveryFaceLineIsAFace) {
  const PolygonMesh mesh =
      ParseOrFail("m.obj", std::string(kTetrahedron) +
                               "f 1 2 3 4\nf 1 1 1\nf 1 2\nf\nf 3\nl 1 2\n"
                               "f 1 2 3\nf 1 2 3\n");
  EXPECT_THAT(Faces(mesh),
              ElementsAre(ElementsAre(0, 1, 2, 3), ElementsAre(0, 0, 0),
                          ElementsAre(0, 1), ElementsAre(), ElementsAre(2),
                          ElementsAre(0, 1, 2), ElementsAre(0, 1, 2)));
}

TEST(ReadObjTest, ReadsNegativeForwardAndContinuedIndices) {
  const PolygonMesh mesh = ParseOrFail("m.obj",
                                       "v 0 0 0\nv 1 0 0\nf 1 2 3\nv 0 1 0\n"
                                       "f -1 -2 \\\n -3\n");
  EXPECT_THAT(Faces(mesh),
              ElementsAre(ElementsAre(0, 1, 2), ElementsAre(2, 1, 0)));
}

TEST(ReadObjTest, ReadsWhatCornersCarry) {
  const PolygonMesh mesh =
      ParseOrFail("m.obj", std::string(kTetrahedron) +
                               "vt 0.5 0.25\nvt 1 1 0\nvn 0 0 1\n"
                               "f 1/1/1 2/2/1 3/1/1\nf 2/2/-1 3/1/1 4/-1/1\n");
  ASSERT_EQ(mesh.corner_uvs.size(), 6u);
  EXPECT_THAT(mesh.corner_uvs[0], ElementsAre(0.5f, 0.25f));
  EXPECT_THAT(mesh.corner_uvs[5], ElementsAre(1, 1));
  ASSERT_EQ(mesh.corner_normals.size(), 6u);
  EXPECT_THAT(mesh.corner_normals[3], ElementsAre(0, 0, 1));
}

TEST(ReadObjTest, ReadsTextureCoordinatesOfOneNumber) {
  const PolygonMesh mesh = ParseOrFail(
      "m.obj", std::string(kTetrahedron) + "vt 0.5\nf 1/1 2/1 3/1\n");
  ASSERT_EQ(mesh.corner_uvs.size(), 3u);
  EXPECT_THAT(mesh.corner_uvs[0], ElementsAre(0.5f, 0));
  ExpectRefused("m.obj", "vt\n", {"line 1", "needs 1 number"});
}

TEST(ReadObjTest, LeavesOutWhatSomeCornersLack) {
  const PolygonMesh mesh =
      ParseOrFail("m.obj", std::string(kTetrahedron) +
                               "vt 0 0\nvn 0 0 1\nf 1//1 2//1 3//1\n"
                               "f 1/1/1 2/1/1 4/1/1\n");
  EXPECT_TRUE(mesh.corner_uvs.empty());
  EXPECT_EQ(mesh.corner_normals.size(), 6u);
}

TEST(ReadObjTest, ReadsNumbersThatAreNotFinite) {
  const PolygonMesh mesh = ParseOrFail(
      "m.obj", "v inf nan +inf\nv nan -nan -Inf\nv 3.00 NaN -NaN\nf 1 2 3\n");
  EXPECT_TRUE(std::isinf(mesh.positions[0][2]));
  EXPECT_TRUE(std::isnan(mesh.positions[1][1]));
  EXPECT_EQ(mesh.positions[2][0], 3.0f);
}

TEST(ReadObjTest, ErrorsNameTheLine) {
  const std::string head = kTetrahedron;
  ExpectRefused("m.obj", head + "f 1 2 99\n",
                {"line 5", "vertex index 99 is out of range", "4 vertices"});
  ExpectRefused("m.obj", head + "f 1 2 0\n", {"line 5", "index 0"});
  ExpectRefused("m.obj", head + "f 1 2 -5\n", {"line 5", "index -5"});
  ExpectRefused("m.obj", head + "f 1 2 x\n", {"line 5", "'x'"});
  ExpectRefused("m.obj", head + "f 1 2 99999999999\n", {"line 5"});
  ExpectRefused("m.obj", "v 0 0\n", {"line 1", "needs 3 numbers"});
  ExpectRefused("m.obj", "v 0 0 0,5\n", {"line 1", "'0,5'"});
  ExpectRefused("m.obj", head, {"no faces"});
  ExpectRefused("m.obj", "some text\nthat is no mesh\n", {"no faces"});
}

TEST(ReadObjTest, SurvivesDamage) {
  ExpectSurvivesDamage("m.obj", std::string(kTetrahedron) +
                                    "vt 0 1\nf 1/1 2/1 3/1\nf -1 -2 \\\n1 2\n");
}

}  // namespace
}  // namespace marrow
