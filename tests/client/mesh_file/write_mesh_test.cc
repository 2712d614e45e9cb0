#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "tests/client/mesh_file/matchers.h"

namespace marrow {
namespace {

PolygonMesh MixedMesh() {
  PolygonMesh mesh;
  mesh.positions = {{0.1f, -0.0f, 1e-45f},
                    {1.0f / 3, std::numeric_limits<float>::max(), 2},
                    {3, 4, 5},
                    {-1e-7f, 16777215, 7}};
  mesh.AddFace(std::array<uint32_t, 3>{0, 1, 2});
  mesh.AddFace(std::array<uint32_t, 4>{3, 2, 1, 0});
  mesh.AddFace(std::array<uint32_t, 3>{0, 0, 1});
  return mesh;
}

std::string TempPath(const std::string& name) {
  return std::filesystem::path(::testing::TempDir()) / ("write_mesh_" + name);
}

class PrecisionTest : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(FloatsAndDoubles, PrecisionTest, ::testing::Bool());

TEST_P(PrecisionTest, ReadsBackToTheBit) {
  PolygonMesh mesh = MixedMesh();
  if (GetParam()) mesh.positions[2] = {0.1, 1e300, 1e7 + 1e-9};
  for (const char* name : {"m.off", "m.obj", "m.ply", "M.PLY"}) {
    const std::string path = TempPath(name);
    ASSERT_TRUE(WriteMesh(mesh, path).ok());
    const absl::StatusOr<PolygonMesh> back = ReadMeshFile(path);
    ASSERT_TRUE(back.ok()) << back.status();
    EXPECT_EQ(back->positions, mesh.positions) << name;
    EXPECT_TRUE(std::signbit(back->positions[0][1])) << name;
    EXPECT_EQ(Faces(*back), Faces(mesh)) << name;
    std::filesystem::remove(path);
  }
}

TEST(WriteMeshTest, WritesPlyFacesOfManyCorners) {
  PolygonMesh mesh;
  mesh.positions.resize(300);
  std::vector<uint32_t> corners(300);
  std::iota(corners.begin(), corners.end(), 0u);
  mesh.AddFace(corners);
  const std::string path = TempPath("many.ply");
  ASSERT_TRUE(WriteMesh(mesh, path).ok());
  const absl::StatusOr<PolygonMesh> back = ReadMeshFile(path);
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(Faces(*back), Faces(mesh));
  std::filesystem::remove(path);
}

TEST(WriteMeshTest, TriangulatesForStl) {
  const std::string path = TempPath("m.stl");
  ASSERT_TRUE(WriteMesh(MixedMesh(), path).ok());
  const absl::StatusOr<PolygonMesh> back = ReadMeshFile(path);
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->NumFaces(), 4u);
  EXPECT_EQ(back->positions[2], MixedMesh().positions[2]);
  std::filesystem::remove(path);
}

TEST(WriteMeshTest, RefusesOtherExtensions) {
  const absl::Status status = WriteMesh(MixedMesh(), TempPath("m.xyz"));
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), ::testing::HasSubstr(".ply"));
  EXPECT_FALSE(std::filesystem::exists(TempPath("m.xyz")));
}

}  // namespace
}  // namespace marrow
