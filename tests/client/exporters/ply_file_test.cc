#include "client/exporters/ply_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "client/exporters/palette.h"
#include "tests/client/exporters/meshes.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;

struct ParsedPly {
  std::string header;
  std::vector<std::array<double, 3>> positions;
  std::vector<Rgb> vertex_colors;
  std::vector<std::vector<uint32_t>> faces;
  std::vector<Rgb> face_colors;
  size_t bytes_left = 0;
};

// Reads little-endian bytes whatever the machine's order.
class ByteReader {
 public:
  explicit ByteReader(std::string bytes) : bytes_(std::move(bytes)) {}

  uint64_t ReadLong(int size) {
    uint64_t value = 0;
    for (int i = 0; i < size; ++i) {
      value |= uint64_t{static_cast<uint8_t>(bytes_.at(at_++))} << (8 * i);
    }
    return value;
  }
  uint32_t Read(int size) { return static_cast<uint32_t>(ReadLong(size)); }
  double ReadCoordinate(bool is_double) {
    return is_double ? std::bit_cast<double>(ReadLong(8))
                     : std::bit_cast<float>(Read(4));
  }
  Rgb ReadColor() {
    Rgb color;
    color.red = static_cast<uint8_t>(Read(1));
    color.green = static_cast<uint8_t>(Read(1));
    color.blue = static_cast<uint8_t>(Read(1));
    return color;
  }
  size_t BytesLeft() const { return bytes_.size() - at_; }

 private:
  std::string bytes_;
  size_t at_ = 0;
};

size_t CountAfter(const std::string& header, const std::string& words) {
  return std::stoul(header.substr(header.find(words) + words.size()));
}

ParsedPly Parse(const std::string& ply) {
  const std::string end = "end_header\n";
  ParsedPly parsed;
  const size_t body = ply.find(end) + end.size();
  parsed.header = ply.substr(0, body);
  ByteReader reader(ply.substr(body));
  const bool wide = parsed.header.find("list uint") != std::string::npos;
  const bool doubles =
      parsed.header.find("property double z") != std::string::npos;
  const size_t vertices = CountAfter(parsed.header, "element vertex ");
  for (size_t v = 0; v < vertices; ++v) {
    const double x = reader.ReadCoordinate(doubles);
    const double y = reader.ReadCoordinate(doubles);
    parsed.positions.push_back({x, y, reader.ReadCoordinate(doubles)});
    parsed.vertex_colors.push_back(reader.ReadColor());
  }
  const size_t faces = CountAfter(parsed.header, "element face ");
  for (size_t f = 0; f < faces; ++f) {
    std::vector<uint32_t> corners(reader.Read(wide ? 4 : 1));
    for (uint32_t& corner : corners) corner = reader.Read(4);
    parsed.faces.push_back(corners);
    parsed.face_colors.push_back(reader.ReadColor());
  }
  parsed.bytes_left = reader.BytesLeft();
  return parsed;
}

TEST(PlyFileTest, HeaderNamesWhatViewersLookFor) {
  const auto [mesh, labels] = MakeStrip();
  const std::string header = Parse(PlyFile(mesh, labels).value()).header;
  EXPECT_TRUE(header.starts_with("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_THAT(header, HasSubstr("property float x\nproperty float y\n"
                                "property float z\nproperty uchar red\n"
                                "property uchar green\nproperty uchar blue\n"));
  EXPECT_THAT(header, HasSubstr("property list uchar int vertex_indices\n"
                                "property uchar red\nproperty uchar green\n"
                                "property uchar blue\nend_header\n"));
}

class PlyPrecisionTest : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(FloatsAndDoubles, PlyPrecisionTest, ::testing::Bool());

TEST_P(PlyPrecisionTest, KeepsPolygonsInOrderWithTheirPositions) {
  auto [mesh, labels] = MakeStrip();
  if (GetParam()) mesh.positions[4] = {1e300, 0.1, -1e7 - 1e-7};
  const ParsedPly ply = Parse(PlyFile(mesh, labels).value());
  ASSERT_EQ(ply.faces.size(), 4u);  // not the one of two corners
  for (size_t f = 0; f < 4; ++f) {
    ASSERT_EQ(ply.faces[f].size(), mesh.Face(f).size());
    for (size_t i = 0; i < ply.faces[f].size(); ++i) {
      EXPECT_EQ(ply.positions.at(ply.faces[f][i]),
                mesh.positions[mesh.Face(f)[i]]);
    }
  }
  EXPECT_EQ(ply.bytes_left, 0u);
}

TEST(PlyFileTest, ColorsArePureOnFacesAndVertices) {
  const auto [mesh, labels] = MakeStrip();
  const ParsedPly ply = Parse(PlyFile(mesh, labels).value());
  ASSERT_EQ(ply.faces.size(), 4u);
  for (size_t f = 0; f < 4; ++f) {
    EXPECT_EQ(ply.face_colors[f], SegmentColor(labels[f]));
    for (uint32_t v : ply.faces[f]) {
      EXPECT_EQ(ply.vertex_colors.at(v), SegmentColor(labels[f]));
    }
  }
}

TEST(PlyFileTest, SplitsVerticesOnlyAlongTheCuts) {
  const auto [mesh, labels] = MakeStrip();
  const ParsedPly ply = Parse(PlyFile(mesh, labels).value());
  // Vertices 1, 5, 2 and 6 lie on the cut; 0, 3 and 4 do not; 7 is unused.
  EXPECT_EQ(ply.positions.size(), 2u * 4 + 3);
  EXPECT_EQ(ply.faces.at(1)[0], ply.faces.at(2)[0]);
}

TEST(PlyFileTest, CountsCornersBeyondAByte) {
  const auto [mesh, labels] = MakePolygon(300);
  const ParsedPly ply = Parse(PlyFile(mesh, labels).value());
  ASSERT_EQ(ply.faces.size(), 1u);
  EXPECT_EQ(ply.faces[0].size(), 300u);
  EXPECT_EQ(ply.bytes_left, 0u);
}

TEST(PlyFileTest, TakesAnEmptyMesh) {
  const ParsedPly ply = Parse(PlyFile(PolygonMesh{}, {}).value());
  EXPECT_TRUE(ply.positions.empty());
  EXPECT_TRUE(ply.faces.empty());
}

TEST(PlyFileTest, RefusesLabelsOfAnotherMesh) {
  const auto status = PlyFile(MakeStrip().mesh, {}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()),
              HasSubstr("0 face labels for a mesh of 5 faces"));
}

}  // namespace
}  // namespace marrow
