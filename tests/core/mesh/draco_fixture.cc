#include "tests/core/mesh/draco_fixture.h"

#include <cmath>
#include <memory>

#include "draco/compression/encode.h"
#include "draco/mesh/triangle_soup_mesh_builder.h"
#include "gtest/gtest.h"

namespace marrow {
namespace {

using draco::GeometryAttribute;

// Texture coordinates are one patch for every 16 faces, normals one for 8.
void AddSeams(const DecodedMesh& mesh,
              draco::TriangleSoupMeshBuilder& builder) {
  const int uv =
      builder.AddAttribute(GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const int normal =
      builder.AddAttribute(GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  for (uint32_t f = 0; f < mesh.faces.size(); ++f) {
    float uvs[3][2];
    for (int i = 0; i < 3; ++i) {
      uvs[i][0] = static_cast<float>(mesh.faces[f][i]);
      uvs[i][1] = static_cast<float>(f / 16);
    }
    builder.SetAttributeValuesForFace(uv, draco::FaceIndex(f), uvs[0], uvs[1],
                                      uvs[2]);
    const float n[3] = {f / 8 % 2 ? 1.0f : 0.0f, f / 8 % 2 ? 0.0f : 1.0f, 0};
    builder.SetAttributeValuesForFace(normal, draco::FaceIndex(f), n, n, n);
  }
}

template <typename Scalar>
void AddPositions(const DecodedMesh& mesh,
                  draco::TriangleSoupMeshBuilder& builder) {
  const int id = builder.AddAttribute(
      GeometryAttribute::POSITION, 3,
      sizeof(Scalar) == 8 ? draco::DT_FLOAT64 : draco::DT_FLOAT32);
  for (uint32_t f = 0; f < mesh.faces.size(); ++f) {
    Scalar xyz[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        xyz[i][j] = static_cast<Scalar>(mesh.positions(mesh.faces[f][i], j));
      }
    }
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(f), xyz[0], xyz[1],
                                      xyz[2]);
  }
}

// Rounds to a multiple of 2^-16, so that 32 bits hold it. A cast to float and
// back would say it better, but GCC 12 drops the pair when it vectorizes.
double OnGrid(double x) { return std::round(x * 65536) / 65536; }

}  // namespace

DecodedMesh Torus(uint32_t rows, uint32_t columns) {
  DecodedMesh mesh;
  mesh.positions.resize(rows * columns, 3);
  for (uint32_t r = 0; r < rows; ++r) {
    for (uint32_t c = 0; c < columns; ++c) {
      const double u = 2 * M_PI * r / rows, v = 2 * M_PI * c / columns;
      const double radius = 3 + std::cos(v);
      mesh.positions.row(r * columns + c) << OnGrid(radius * std::cos(u)),
          OnGrid(radius * std::sin(u)), OnGrid(std::sin(v));
      const uint32_t r1 = (r + 1) % rows, c1 = (c + 1) % columns;
      const uint32_t corners[4] = {r * columns + c, r1 * columns + c,
                                   r1 * columns + c1, r * columns + c1};
      mesh.faces.push_back({corners[0], corners[1], corners[2]});
      mesh.faces.push_back({corners[0], corners[2], corners[3]});
    }
  }
  return mesh;
}

std::string EncodeDraco(const DecodedMesh& mesh, const EncodeOptions& options) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(mesh.faces.size()));
  if (options.double_precision) {
    AddPositions<double>(mesh, builder);
  } else {
    AddPositions<float>(mesh, builder);
  }
  if (options.seams) AddSeams(mesh, builder);
  const std::unique_ptr<draco::Mesh> soup = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(options.edgebreaker
                                ? draco::MESH_EDGEBREAKER_ENCODING
                                : draco::MESH_SEQUENTIAL_ENCODING);
  encoder.SetSpeedOptions(options.speed, options.speed);
  if (options.quantization_bits > 0) {
    encoder.SetAttributeQuantization(GeometryAttribute::POSITION,
                                     options.quantization_bits);
  }
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(*soup, &buffer);
  EXPECT_TRUE(status.ok()) << status.error_msg_string();
  return std::string(buffer.data(), buffer.size());
}

}  // namespace marrow
