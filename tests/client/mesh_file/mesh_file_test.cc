#include "client/mesh_file/mesh_file.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/client/mesh_file/matchers.h"

namespace marrow {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr char kOff[] = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST(DetectMeshFormatTest, GoesByExtensionThenByContent) {
  EXPECT_EQ(DetectMeshFormat("a.OFF", "ply\n"), MeshFormat::kOff);
  EXPECT_EQ(DetectMeshFormat("a.b.Obj", ""), MeshFormat::kObj);
  EXPECT_EQ(DetectMeshFormat("a.glb", ""), MeshFormat::kGltf);
  EXPECT_EQ(DetectMeshFormat("a.drc", ""), MeshFormat::kDraco);
  EXPECT_EQ(DetectMeshFormat("a", "ply\nformat"), MeshFormat::kPly);
  EXPECT_EQ(DetectMeshFormat("a.txt", kOff), MeshFormat::kOff);
  EXPECT_EQ(DetectMeshFormat("a", "# x\nv 0 0 0\n"), MeshFormat::kObj);
  for (const std::string keyword :
       {"f", "g", "o", "s", "vn", "vt", "usemtl", "mtllib"}) {
    EXPECT_EQ(DetectMeshFormat("-", keyword + " 1\n"), MeshFormat::kObj);
  }
  EXPECT_EQ(DetectMeshFormat("a", "solid x\n"), MeshFormat::kStl);
  EXPECT_EQ(DetectMeshFormat("a", "DRACO\x02\x02"), MeshFormat::kDraco);
  EXPECT_EQ(DetectMeshFormat("a", "glTF"), MeshFormat::kGltf);
  EXPECT_EQ(DetectMeshFormat("a", "{\"asset\""), MeshFormat::kGltf);
  EXPECT_EQ(DetectMeshFormat("a.png", "\x89PNG"), MeshFormat::kUnknown);
}

// Its header may be anything; its number of triangles gives its size.
TEST(DetectMeshFormatTest, KnowsABinaryStlByItsSize) {
  std::string stl = "OFF by its name";
  stl.resize(80, ' ');
  stl += std::string("\x02\0\0\0", 4) + std::string(100, '\0');
  EXPECT_EQ(DetectMeshFormat("-", stl), MeshFormat::kStl);
  EXPECT_EQ(ParseOrFail("-", stl).NumFaces(), 2u);
  stl[0] = '\0';
  EXPECT_EQ(DetectMeshFormat("-", stl), MeshFormat::kStl);
  EXPECT_EQ(DetectMeshFormat("-", stl + " "), MeshFormat::kUnknown);
  EXPECT_EQ(DetectMeshFormat("-", std::string(84, '\0')), MeshFormat::kUnknown);
}

TEST(ParseMeshTest, FindsTheFormatOfAnUnknownExtension) {
  EXPECT_EQ(ParseOrFail("mesh.txt", kOff).NumFaces(), 1u);
  ExpectRefused("mesh.png", "\x89PNG", {".off", ".drc"});
  ExpectRefused("mesh.fbx", "v 0 0 0\n", {"no format", ".off", ".drc"});
  ExpectRefused("mesh", "v 0 0 0\n", {"no faces"});
  ExpectRefused("mesh.drc", "DRACO", {"Draco"});
}

class ReadMeshFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Write(const std::string& name, const std::string& bytes) {
    const std::string path = folder_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

  fs::path folder_;
};

TEST_F(ReadMeshFileTest, ReadsAFile) {
  const absl::StatusOr<PolygonMesh> mesh = ReadMeshFile(Write("m.off", kOff));
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->NumFaces(), 1u);
}

TEST_F(ReadMeshFileTest, ReadsBytesUnchanged) {
  std::string bytes(3 << 20, '\0');
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7);
  const absl::StatusOr<std::string> read = ReadFileBytes(Write("x", bytes));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(*read, bytes);
}

TEST_F(ReadMeshFileTest, ADashIsStandardInput) {
  const int kept = dup(STDIN_FILENO);
  ASSERT_NE(std::freopen(Write("m", kOff).c_str(), "r", stdin), nullptr);
  const absl::StatusOr<std::string> read = ReadFileBytes("-");
  dup2(kept, STDIN_FILENO);
  close(kept);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(*read, kOff);
}

TEST_F(ReadMeshFileTest, ErrorsNameThePath) {
  const std::string missing = folder_ / "missing.off";
  absl::Status status = ReadMeshFile(missing).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(status.message()), HasSubstr(missing));

  status = ReadMeshFile(folder_.string()).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("is a folder"));

  status = ReadMeshFile(Write("empty.obj", "")).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("is empty"));
}

// Faces of a text file, counted in another way than the reader does: lines
// that begin with 'f' in an OBJ, the header's number in an OFF.
size_t CountFaces(const fs::path& path) {
  std::ifstream in(path);
  std::string line;
  size_t count = 0;
  if (path.extension() == ".off") {
    size_t vertices = 0;
    in >> line >> vertices >> count;
    return count;
  }
  while (std::getline(in, line)) {
    if (line == "f" || line.rfind("f ", 0) == 0) ++count;
  }
  return count;
}

void ExpectRead(const fs::path& path) {
  const absl::StatusOr<PolygonMesh> mesh = ReadMeshFile(path);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  ExpectConsistent(*mesh);
  const MeshFormat format = DetectMeshFormat(path, "");
  if (format == MeshFormat::kOff || format == MeshFormat::kObj) {
    EXPECT_EQ(mesh->NumFaces(), CountFaces(path)) << path;
  }
}

TEST(MeshDataTest, ReadsEveryFile) {
  const char* data = std::getenv("MARROW_DATA");
  if (data == nullptr || !fs::is_directory(data)) {
    GTEST_SKIP() << "set MARROW_DATA to the folder of development meshes";
  }
  int read = 0;
  for (const char* folder : {"meshes", "dirty", "rigged", "large"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(data) / folder)) {
      if (!entry.is_regular_file() ||
          DetectMeshFormat(entry.path(), "") == MeshFormat::kUnknown) {
        continue;
      }
      ExpectRead(entry.path());
      ++read;
    }
  }
  EXPECT_GT(read, 30);
}

}  // namespace
}  // namespace marrow
