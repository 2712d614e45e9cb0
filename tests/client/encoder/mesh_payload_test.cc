#include "client/encoder/mesh_payload.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "client/mesh_file/mesh_file.h"
#include "core/base/error_reason.h"
#include "tests/client/encoder/shapes.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;

std::string WriteTemp(const std::string& name, const std::string& bytes) {
  const std::string path =
      std::filesystem::path(::testing::TempDir()) / ("mesh_payload_" + name);
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

TEST(LoadMeshPayloadTest, SendsDracoBytesAsTheyAre) {
  const std::string bytes = EncodeMesh(Torus(false), {})->bytes;
  for (const char* name : {"m.drc", "m.unknown"}) {
    const auto payload =
        LoadMeshPayload(WriteTemp(name, bytes), {}, MeshLimits());
    ASSERT_TRUE(payload.ok()) << payload.status();
    EXPECT_EQ(payload->encoded.bytes, bytes);
    const auto decoded = DecodeDraco(bytes, MeshLimits());
    ASSERT_EQ(payload->mesh.NumFaces(), decoded->faces.size());
    for (uint32_t f = 0; f < payload->mesh.NumFaces(); ++f) {
      EXPECT_TRUE(std::ranges::equal(payload->mesh.Face(f), decoded->faces[f]));
    }
    std::vector<uint32_t> numbers(decoded->faces.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
    EXPECT_EQ(*payload->encoded.order.FaceLabelsInFileOrder(numbers), numbers);
    numbers.resize(payload->mesh.NumVertices());
    EXPECT_EQ(*payload->encoded.order.VertexLabelsInFileOrder(numbers),
              numbers);
  }
}

TEST(LoadMeshPayloadTest, EncodesOtherFiles) {
  const std::string path = WriteTemp("m.off", "");
  ASSERT_TRUE(WriteMesh(Polygons(), path).ok());
  const auto payload = LoadMeshPayload(path, {}, MeshLimits());
  ASSERT_TRUE(payload.ok()) << payload.status();
  EXPECT_EQ(payload->mesh.NumFaces(), Polygons().NumFaces());
  EXPECT_EQ(payload->encoded.bytes, EncodeMesh(Polygons(), {})->bytes);
}

TEST(LoadMeshPayloadTest, NamesTheFilesVertexThatIsNotFinite) {
  PolygonMesh mesh = Torus(false);
  mesh.positions[17][1] = std::numeric_limits<double>::quiet_NaN();
  const std::string path = WriteTemp("nan.obj", "");
  ASSERT_TRUE(WriteMesh(mesh, path).ok());
  const auto payload = LoadMeshPayload(path, {}, MeshLimits());
  EXPECT_EQ(ReasonOf(payload.status()), kReasonMeshRejected);
  EXPECT_THAT(payload.status().message(),
              HasSubstr("vertex 17, counted from 0, is not finite"));
}

TEST(LoadMeshPayloadTest, RefusesAMeshThatIsOnePoint) {
  const std::string path =
      WriteTemp("point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n");
  const absl::Status status =
      LoadMeshPayload(path, EncodeOptions(), MeshLimits()).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("one position"));
}

TEST(LoadMeshPayloadTest, ErrorsBeginWithThePathAndKeepTheirReason) {
  const std::string broken = WriteTemp("broken.drc", "DRACO\x02\x02");
  const absl::Status status =
      LoadMeshPayload(broken, {}, MeshLimits()).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(std::string(status.message()).rfind(broken + ": ", 0), 0u);
  EXPECT_EQ(ReasonOf(status), kReasonDracoDecodeFailed);

  const std::string edges = WriteTemp("edges.off", "OFF\n1 1 0\n0 0 0\n1 0\n");
  EXPECT_THAT(
      std::string(LoadMeshPayload(edges, {}, MeshLimits()).status().message()),
      HasSubstr(edges + ": the mesh has no face"));
}

}  // namespace
}  // namespace marrow
