#include "core/mesh/decode.h"

#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error_reason.h"
#include "core/mesh/canonical_mesh.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/mesh/draco_fixture.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;

void ExpectValid(const DecodedMesh& mesh) {
  ASSERT_FALSE(mesh.faces.empty());
  EXPECT_TRUE(mesh.positions.allFinite());
  for (const Triangle& face : mesh.faces) {
    for (uint32_t corner : face) ASSERT_LT(corner, mesh.positions.rows());
  }
}

void ExpectRejected(const absl::Status& status, const char* reason,
                    const std::string& text) {
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ReasonOf(status), reason);
  EXPECT_THAT(std::string(status.message()), HasSubstr(text));
}

// A mesh within the limits, or an error with words and a reason.
void ExpectAnswer(const std::string& bytes, const MeshLimits& limits) {
  const absl::StatusOr<DecodedMesh> decoded = DecodeDraco(bytes, limits);
  absl::Status status = decoded.status();
  if (decoded.ok()) {
    ExpectValid(*decoded);
    EXPECT_LE(decoded->faces.size(), limits.max_faces);
    EXPECT_LE(decoded->positions.rows(), limits.max_vertices);
    status = Canonicalize(*decoded).status();
  }
  if (status.ok()) return;
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_FALSE(ReasonOf(status).empty());
  EXPECT_GE(status.message().size(), 10u);
}

// A sequential file of one face over three points, written by hand.
std::string OneTriangle(const float (&xyz)[9], const uint8_t (&face)[3]) {
  std::string bytes("DRACO\2\2\1\0\0\0", 11);
  bytes += std::string("\1\3\1", 3);  // faces, points, plain indices
  bytes.append(reinterpret_cast<const char*>(face), 3);
  // One decoder of one attribute: POSITION, FLOAT32, 3, as it is, id 0.
  bytes += std::string("\1\1\0\11\3\0\0\0", 8);
  bytes.append(reinterpret_cast<const char*>(xyz), sizeof(xyz));
  return bytes;
}

constexpr float kRightTriangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

struct Setting {
  bool edgebreaker;
  bool seams;
  int speed;
};

std::vector<Setting> AllSettings() {
  std::vector<Setting> settings;
  for (bool edgebreaker : {false, true}) {
    for (bool seams : {false, true}) {
      for (int speed = 0; speed <= 10; ++speed) {
        settings.push_back({edgebreaker, seams, speed});
      }
    }
  }
  return settings;
}

std::string NameOf(const ::testing::TestParamInfo<Setting>& info) {
  return std::string(info.param.edgebreaker ? "Edgebreaker" : "Sequential") +
         (info.param.seams ? "Seams" : "Plain") +
         std::to_string(info.param.speed);
}

class EncoderSettingTest : public ::testing::TestWithParam<Setting> {};

TEST_P(EncoderSettingTest, DecodesAndWeldsToTheSameMesh) {
  const DecodedMesh torus = Torus(12, 16);
  EncodeOptions options;
  options.edgebreaker = GetParam().edgebreaker;
  options.seams = GetParam().seams;
  options.speed = GetParam().speed;
  const auto decoded = DecodeDraco(EncodeDraco(torus, options), {});
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  ExpectValid(*decoded);
  EXPECT_EQ(decoded->faces.size(), torus.faces.size());
  if (GetParam().seams) {
    EXPECT_GT(decoded->positions.rows(), torus.positions.rows());
  }

  const auto expected = Canonicalize(torus);
  const auto actual = Canonicalize(*decoded);
  ASSERT_TRUE(expected.ok() && actual.ok());
  EXPECT_EQ(actual->mesh.positions, expected->mesh.positions);
  EXPECT_EQ(actual->mesh.faces, expected->mesh.faces);
  EXPECT_EQ(actual->geometry_digest, expected->geometry_digest);
  EXPECT_EQ(actual->report.boundary_edges, 0u);
}

INSTANTIATE_TEST_SUITE_P(All, EncoderSettingTest,
                         ::testing::ValuesIn(AllSettings()), NameOf);

TEST(DecodeTest, KeepsDoublePrecision) {
  DecodedMesh mesh = Torus(4, 5);
  mesh.positions *= 1.0 / 3.0;
  EncodeOptions options;
  options.edgebreaker = false;
  options.double_precision = true;
  const auto decoded = DecodeDraco(EncodeDraco(mesh, options), {});
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  const auto expected = Canonicalize(mesh), actual = Canonicalize(*decoded);
  ASSERT_TRUE(expected.ok() && actual.ok());
  EXPECT_EQ(actual->mesh.positions, expected->mesh.positions);
}

TEST(DecodeTest, DecodesQuantizedPositions) {
  EncodeOptions options;
  options.quantization_bits = 14;
  const auto decoded = DecodeDraco(EncodeDraco(Torus(8, 8), options), {});
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  ExpectValid(*decoded);
  const auto canonical = Canonicalize(*decoded);
  ASSERT_TRUE(canonical.ok());
  EXPECT_EQ(canonical->report.euler_characteristic, 0);
}

TEST(DecodeTest, IndexOutOfRangeNamesTheFace) {
  const auto decoded =
      DecodeDraco(OneTriangle(kRightTriangle, {0, 1, 200}), {});
  ExpectRejected(decoded.status(), kReasonMeshRejected,
                 "face 0 refers to point 200");
  EXPECT_TRUE(DecodeDraco(OneTriangle(kRightTriangle, {0, 1, 2}), {}).ok());
}

TEST(DecodeTest, CoordinateThatIsNotFiniteNamesThePoint) {
  for (float bad : {std::numeric_limits<float>::quiet_NaN(),
                    std::numeric_limits<float>::infinity(),
                    -std::numeric_limits<float>::infinity()}) {
    const float xyz[9] = {0, 0, 0, 1, 0, 0, 0, bad, 0};
    ExpectRejected(DecodeDraco(OneTriangle(xyz, {0, 1, 2}), {}).status(),
                   kReasonMeshRejected, "point 2 is not finite");
  }
}

TEST(DecodeTest, PointsOverTheLimitAreRefused) {
  EncodeOptions options;
  options.seams = true;
  const std::string bytes = EncodeDraco(Torus(12, 16), options);
  MeshLimits limits;
  limits.max_vertices = 12 * 16;  // enough, but for the seams
  ExpectRejected(DecodeDraco(bytes, limits).status(), kReasonMeshRejected,
                 "the limit is 192");
}

TEST(DecodeTest, TrailingBytesAreIgnored) {
  std::string bytes = OneTriangle(kRightTriangle, {0, 1, 2});
  bytes.append(1 << 20, '\xA5');
  EXPECT_TRUE(DecodeDraco(bytes, {}).ok());
}

// Both methods, and of edgebreaker the valence and the standard traversal.
std::vector<EncodeOptions> SeamOptions() {
  std::vector<EncodeOptions> all;
  for (bool edgebreaker : {false, true}) {
    for (int speed : {0, 5, 10}) {
      for (int bits : {0, 11}) {
        all.push_back({.edgebreaker = edgebreaker,
                       .speed = speed,
                       .seams = true,
                       .quantization_bits = bits});
      }
    }
  }
  return all;
}

TEST(DecodeTest, SurvivesTruncationAtEveryByte) {
  for (const EncodeOptions& options : SeamOptions()) {
    const std::string bytes = EncodeDraco(Torus(4, 4), options);
    for (size_t size = 0; size < bytes.size(); ++size) {
      ExpectAnswer(bytes.substr(0, size), {});
    }
    EXPECT_TRUE(DecodeDraco(bytes, {}).ok());
    EXPECT_FALSE(DecodeDraco(bytes.substr(0, bytes.size() / 2), {}).ok());
  }
}

TEST(DecodeTest, SurvivesEveryFlippedBit) {
  MeshLimits limits;
  limits.max_faces = limits.max_vertices = 10'000;
  for (const EncodeOptions& options : SeamOptions()) {
    const std::string good = EncodeDraco(Torus(4, 4), options);
    for (size_t bit = 0; bit < 8 * good.size(); ++bit) {
      std::string bytes = good;
      bytes[bit / 8] ^= static_cast<char>(1 << bit % 8);
      ExpectAnswer(bytes, limits);
    }
  }
}

std::string ReadAll(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

std::filesystem::path DataFolder(const char* name) {
  const char* data = std::getenv("MARROW_DATA");
  return std::filesystem::path(data ? data : "") / "draco" / name;
}

TEST(DecodeDataTest, AnswersHostileFilesInTimeAndMemory) {
  const auto folder = DataFolder("hostile");
  if (!std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "set MARROW_DATA to a folder with draco/hostile";
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path());
    const auto start = std::chrono::steady_clock::now();
    ExpectAnswer(ReadAll(entry.path()), {});
    EXPECT_LT(std::chrono::steady_clock::now() - start,
              std::chrono::seconds(30));
  }
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, 4 << 20) << "KiB";
}

TEST(DecodeDataTest, DecodesGoodFilesAndNamesTheOthers) {
  const auto folder = DataFolder("good");
  if (!std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "set MARROW_DATA to a folder with draco/good";
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path());
    const std::string bytes = ReadAll(entry.path());
    const auto decoded = DecodeDraco(bytes, {});
    if (bytes.at(7) == 0) {
      ExpectRejected(decoded.status(), kReasonDracoDecodeFailed, "point cloud");
    } else if (bytes.at(5) < 2) {
      ExpectRejected(decoded.status(), kReasonDracoDecodeFailed, "version 1.");
    } else {
      ASSERT_TRUE(decoded.ok()) << decoded.status();
      ExpectValid(*decoded);
      EXPECT_TRUE(Canonicalize(*decoded).ok());
    }
  }
}

}  // namespace
}  // namespace marrow
