#include "tests/testing/draco_encode.h"

#include <draco/compression/encode.h>

#include <array>
#include <stdexcept>

namespace marrow {

std::string EncodeDraco(const TriangleMesh& mesh) {
  draco::Mesh encoded;
  encoded.set_num_points(mesh.NumVertices());
  encoded.SetNumFaces(mesh.NumFaces());
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    draco::Mesh::Face face;
    for (int i = 0; i < 3; ++i) face[i] = draco::PointIndex(mesh.faces[f][i]);
    encoded.SetFace(draco::FaceIndex(f), face);
  }
  draco::GeometryAttribute description;
  description.Init(draco::GeometryAttribute::POSITION, nullptr, 3,
                   draco::DT_FLOAT32, false, 3 * sizeof(float), 0);
  draco::PointAttribute* positions = encoded.attribute(
      encoded.AddAttribute(description, true, mesh.NumVertices()));
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    const Eigen::Vector3f p = mesh.Position(v).cast<float>();
    positions->SetAttributeValue(draco::AttributeValueIndex(v), p.data());
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  encoder.SetSpeedOptions(10, 10);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeMeshToBuffer(encoded, &buffer).ok())
    throw std::runtime_error("draco does not encode a test mesh");
  return std::string(buffer.data(), buffer.size());
}

}  // namespace marrow
