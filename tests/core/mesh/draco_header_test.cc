#include "core/mesh/draco_header.h"

#include <string>
#include <vector>

#include "core/base/error_reason.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/mesh/draco_fixture.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;

std::string Bytes(const std::vector<int>& values) {
  return std::string(values.begin(), values.end());
}

std::string Varint(uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7) {
    bytes += static_cast<char>(value | 0x80);
  }
  return bytes + static_cast<char>(value);
}

std::string FileHeader(int minor, int method, int flags_high = 0) {
  return "DRACO" + Bytes({2, minor, 1, method, 0, flags_high});
}

struct Counts {
  uint64_t vertices = 5, faces = 6, attribute_data = 0, symbols = 5, splits = 0;
};

std::string Edgebreaker(const Counts& counts, int traversal = 0) {
  return FileHeader(2, 1) + Bytes({traversal}) + Varint(counts.vertices) +
         Varint(counts.faces) +
         Bytes({static_cast<int>(counts.attribute_data)}) +
         Varint(counts.symbols) + Varint(counts.splits);
}

void ExpectError(const absl::Status& status, const char* reason,
                 const std::string& text) {
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ReasonOf(status), reason);
  EXPECT_THAT(std::string(status.message()), HasSubstr(text));
}

void ExpectMalformed(const std::string& bytes, const std::string& text) {
  ExpectError(ParseDracoHeader(bytes, {}).status(), kReasonDracoDecodeFailed,
              text);
}

void ExpectRejected(const std::string& bytes, const std::string& text) {
  ExpectError(ParseDracoHeader(bytes, {}).status(), kReasonMeshRejected, text);
}

TEST(DracoHeaderTest, ReadsWhatDracoWrites) {
  for (bool edgebreaker : {false, true}) {
    EncodeOptions options;
    options.edgebreaker = edgebreaker;
    const auto header =
        ParseDracoHeader(EncodeDraco(Torus(10, 20), options), {});
    ASSERT_TRUE(header.ok()) << header.status();
    EXPECT_EQ(header->version_minor, 2);
    EXPECT_EQ(header->method, edgebreaker ? DracoMethod::kEdgebreaker
                                          : DracoMethod::kSequential);
    EXPECT_EQ(header->faces, 400u);
    EXPECT_EQ(header->vertices, 200u);
  }
}

TEST(DracoHeaderTest, OlderMinorVersionsHaveOtherCounts) {
  const auto sequential = ParseDracoHeader(
      FileHeader(1, 0) + Bytes({2, 0, 0, 0, 4, 0, 0, 0, 1}), {});
  ASSERT_TRUE(sequential.ok()) << sequential.status();
  EXPECT_EQ(sequential->faces, 2u);
  EXPECT_EQ(sequential->vertices, 4u);
  const auto edgebreaker =
      ParseDracoHeader(FileHeader(0, 1) + Bytes({0, 9, 4, 2, 0, 2, 0}), {});
  ASSERT_TRUE(edgebreaker.ok()) << edgebreaker.status();
  EXPECT_EQ(edgebreaker->faces, 2u);
  EXPECT_EQ(edgebreaker->vertices, 4u);
}

TEST(DracoHeaderTest, NamesWhatIsNotAMesh) {
  ExpectMalformed("", "empty");
  ExpectMalformed("v 0 0 0\nv 1 0 0\n", "byte 0: the file does not begin");
  ExpectMalformed("DRACO", "ends within the version");
  ExpectMalformed("DRACO" + Bytes({1, 2, 1, 0, 0, 0}), "version 1.2");
  ExpectMalformed("DRACO" + Bytes({9, 9, 1, 0, 0, 0}), "version 9.9");
  ExpectMalformed("DRACO" + Bytes({2, 3, 1, 0, 0, 0}), "version 2.3");
  ExpectMalformed("DRACO" + Bytes({2, 3, 0, 1, 0, 0}), "point cloud");
  ExpectMalformed("DRACO" + Bytes({2, 2, 7, 0, 0, 0}), "unknown type");
  ExpectMalformed(FileHeader(2, 2), "unknown encoding method 2");
  ExpectMalformed(FileHeader(2, 1, 0x40), "unknown flags");
  ExpectMalformed(Edgebreaker({}, 1), "unknown traversal type 1");
}

TEST(DracoHeaderTest, BoundsTheCounts) {
  ASSERT_TRUE(ParseDracoHeader(Edgebreaker({}), {}).ok());
  ExpectRejected(Edgebreaker({.faces = 0}), "no faces");
  ExpectRejected(Edgebreaker({.faces = 100'000'000}),
                 "declares 100000000 faces, the limit is 4000000");
  ExpectRejected(Edgebreaker({.vertices = 2'000'001, .faces = 3'000'000}),
                 "declares 2000001 vertices");
  ExpectRejected(Edgebreaker({.attribute_data = 9}), "9 attributes");
  ExpectRejected(Edgebreaker({.vertices = 2}), "has 2 vertices");
  ExpectMalformed(Edgebreaker({.vertices = 19}), "19 vertices cannot");
  ExpectMalformed(Edgebreaker({.symbols = 7}), "7 symbols cannot");
  ExpectMalformed(Edgebreaker({.symbols = 4}), "4 symbols cannot");
  ExpectMalformed(Edgebreaker({.splits = 6}), "6 splits");
}

TEST(DracoHeaderTest, BoundsTheBytes) {
  MeshLimits limits;
  limits.max_bytes = 10;
  ExpectError(ParseDracoHeader(Edgebreaker({}), limits).status(),
              kReasonMeshRejected, "the limit is 10");
}

TEST(DracoHeaderTest, VarintsHave32Bits) {
  const std::string start = FileHeader(2, 0);
  ExpectMalformed(start + std::string(12, '\x81') + '\1', "32 bits");
  ExpectMalformed(start + std::string(4, '\xFF') + '\x1F', "32 bits");
  ExpectRejected(start + std::string(4, '\xFF') + '\x0F' + "\3\1",
                 "declares 4294967295 faces");
}

// A chain of `depth` nested metadata under the geometry's own.
std::string NestedMetadata(size_t depth) {
  std::string bytes = FileHeader(2, 0, 0x80) + Bytes({0, 0});
  for (size_t i = 0; i < depth; ++i) bytes += Bytes({1, 1, 'n', 0});
  return bytes + Bytes({0}) + Bytes({1, 3, 1});
}

TEST(DracoHeaderTest, WalksMetadata) {
  const std::string entry = Bytes({4, 'n', 'a', 'm', 'e', 2, 'o', 'k'});
  const std::string bytes =
      FileHeader(2, 0, 0x80) + Bytes({1, 7, 1}) + entry + Bytes({0}) +  // of 7
      Bytes({2}) + entry + entry + Bytes({2}) + Bytes({1, 'a', 0, 0}) +
      Bytes({0, 0, 0}) + Bytes({1, 3, 1});
  const auto header = ParseDracoHeader(bytes, {});
  ASSERT_TRUE(header.ok()) << header.status();
  EXPECT_EQ(header->vertices, 3u);
  EXPECT_TRUE(ParseDracoHeader(NestedMetadata(1000), {}).ok());
}

TEST(DracoHeaderTest, BoundsMetadata) {
  ExpectRejected(NestedMetadata(100'000), "nested deeper");
  const std::string start = FileHeader(2, 0, 0x80);
  ExpectRejected(start + Varint(0xFFFFFFFF), "metadata for 4294967295");
  ExpectRejected(start + Bytes({0}) + Varint(1'000'000), "metadata entries");
  ExpectRejected(start + Bytes({0, 0}) + Varint(1'000'000), "nested deeper");
  ExpectMalformed(start + Bytes({0, 1, 200, 'x'}), "metadata name");
  ExpectMalformed(start + Bytes({0, 1, 1, 'x', 100, 'y'}), "metadata value");
  ExpectMalformed(start + Bytes({0, 1, 1, 'x', 0}), "empty metadata value");
}

TEST(DracoHeaderTest, SurvivesTruncationAtEveryByte) {
  const std::string bytes = NestedMetadata(5);
  ASSERT_TRUE(ParseDracoHeader(bytes, {}).ok());
  for (size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(ParseDracoHeader(bytes.substr(0, size), {}).ok()) << size;
  }
}

// The section of one sequential decoder. An attribute is type, data type,
// components, normalized, id.
absl::Status CheckAttributes(const std::vector<std::vector<int>>& attributes,
                             uint64_t points = 100) {
  std::string bytes = "behind" + Bytes({1}) + Varint(attributes.size());
  for (const auto& attribute : attributes) bytes += Bytes(attribute);
  bytes += std::string(attributes.size(), '\0');
  return CheckDracoAttributes(bytes, 6, DracoMethod::kSequential, points);
}

TEST(DracoAttributesTest, WantsOnePositionOfThreeFloats) {
  const std::vector<int> position = {0, 9, 3, 0, 0};
  const std::vector<int> uv = {3, 9, 2, 0, 1};
  EXPECT_TRUE(CheckAttributes({position}).ok());
  EXPECT_TRUE(CheckAttributes({uv, {0, 10, 3, 0, 0}}).ok());
  ExpectError(CheckAttributes({}), kReasonMeshRejected, "0 POSITION");
  ExpectError(CheckAttributes({uv}), kReasonMeshRejected, "0 POSITION");
  ExpectError(CheckAttributes({position, position}), kReasonMeshRejected,
              "2 POSITION");
  for (int components : {1, 2, 4, 255}) {
    ExpectError(CheckAttributes({{0, 9, components, 0, 0}}),
                kReasonMeshRejected, "must have 3");
  }
  for (int integer : {1, 2, 5, 8, 11}) {
    ExpectError(CheckAttributes({{0, integer, 3, 0, 0}}), kReasonMeshRejected,
                "FLOAT32 or FLOAT64");
  }
  ExpectError(CheckAttributes({{3, 12, 2, 0, 1}}), kReasonDracoDecodeFailed,
              "unknown type");
  ExpectError(CheckAttributes({{3, 9, 0, 0, 1}}), kReasonDracoDecodeFailed,
              "no components");
}

TEST(DracoAttributesTest, BoundsMemory) {
  const std::vector<int> position = {0, 9, 3, 0, 0};
  const std::vector<int> wide = {4, 10, 255, 0, 1};
  EXPECT_TRUE(CheckAttributes({position, wide}, 300'000).ok());
  ExpectError(CheckAttributes({position, wide}, 2'000'000), kReasonMeshRejected,
              "bytes to decode");
  ExpectError(CheckAttributes(std::vector(65, position)), kReasonMeshRejected,
              "more than 64");
}

TEST(DracoAttributesTest, NamesTheEndOfTheFile) {
  const std::string bytes = Bytes({1, 2, 0, 9, 3, 0, 0, 3, 9});
  for (size_t size = 0; size <= bytes.size(); ++size) {
    ExpectError(CheckDracoAttributes(bytes.substr(0, size), 0,
                                     DracoMethod::kSequential, 3),
                kReasonDracoDecodeFailed, "ends within");
  }
}

}  // namespace
}  // namespace marrow
