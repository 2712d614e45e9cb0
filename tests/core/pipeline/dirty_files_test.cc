// What becomes of files as they are found in the world, as a table.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include "client/encoder/encode.h"
#include "client/mesh_file/mesh_file.h"
#include "tests/testing/bounded_run.h"

namespace marrow {
namespace {

const std::map<std::string, Outcome>& Outcomes() {
  static const auto* outcomes = new std::map<std::string, Outcome>{
      {"beast_nonmanifold.obj", Segments(2, 200)},
      {"camel-gallop-01.off", Segments(2, 200)},
      {"camel-gallop-02.off", Segments(2, 200)},
      // A machine part: what came off at the last level was 0.2 % of its area.
      {"conrod.stl", Segments(1, 200)},
      {"cube_quads.obj", Segments(1, 10)},
      {"cycloidal.ply", Segments(2, 200)},
      {"deg_faces.obj", Segments(1, 10)},
      {"degenerate_mesh.obj", Refused("degenerate")},
      {"elephant-with-holes.off", Segments(2, 200)},
      {"extra_vertex.obj", Segments(1, 10)},
      {"fuze_ascii.ply", Segments(1, 200)},
      {"inf_nan.obj", Refused("point 0 is not finite")},
      {"multiple_isolated_triangles.obj", Segments(1, 10)},
      {"multiple_tetrahedrons.obj", Segments(1, 10)},
      {"non_manifold_wrap.obj", Segments(1, 10)},
      {"ogre_44_components.obj", Segments(5, 60)},
      {"suzanne.obj", Segments(2, 200)},
      {"test_nm.obj", Segments(1, 60)},
  };
  return *outcomes;
}

class DirtyFileTest
    : public ::testing::TestWithParam<std::pair<const std::string, Outcome>> {
 protected:
  void SetUp() override {
    const char* data = std::getenv("MARROW_DATA");
    if (data == nullptr || !std::filesystem::exists(Folder()))
      GTEST_SKIP() << "set MARROW_DATA to a folder with dirty";
  }
  static std::filesystem::path Folder() {
    return std::filesystem::path(std::getenv("MARROW_DATA")) / "dirty";
  }
};

TEST_P(DirtyFileTest, EndsAsTheTableSays) {
  const auto& [name, outcome] = GetParam();
  const auto mesh = ReadMeshFile((Folder() / name).string());
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  const auto encoded = EncodeMesh(*mesh, {});
  ASSERT_TRUE(encoded.ok()) << encoded.status();
  const BoundedRun run = RunWithinBounds(encoded->bytes, {});
  ExpectOutcome(outcome, run, encoded->order.NumDecodedFaces(),
                encoded->order.NumDecodedPoints());
  for (const auto& level : run.sink.levels) {
    const auto labels = encoded->order.FaceLabelsInFileOrder(level.face_labels);
    ASSERT_TRUE(labels.ok()) << labels.status();
    ASSERT_EQ(labels->size(), mesh->NumFaces());
    for (uint32_t label : *labels) ASSERT_LT(label, run.sink.tree.nodes.size());
  }
}

std::string TestName(
    const ::testing::TestParamInfo<std::pair<const std::string, Outcome>>&
        info) {
  std::string name = info.param.first;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, DirtyFileTest, ::testing::ValuesIn(Outcomes()),
                         TestName);

}  // namespace
}  // namespace marrow
