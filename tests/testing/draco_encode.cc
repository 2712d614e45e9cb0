#include "tests/testing/draco_encode.h"

#include <draco/compression/encode.h>

#include <array>
#include <stdexcept>

namespace marrow {
namespace {

template <typename Scalar>
void AddPositions(const TriangleMesh& mesh, draco::DataType type,
                  draco::Mesh& encoded) {
  draco::GeometryAttribute description;
  description.Init(draco::GeometryAttribute::POSITION, nullptr, 3, type, false,
                   3 * sizeof(Scalar), 0);
  draco::PointAttribute* positions = encoded.attribute(
      encoded.AddAttribute(description, true, mesh.NumVertices()));
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    const Eigen::Vector3<Scalar> p = mesh.Position(v).cast<Scalar>();
    positions->SetAttributeValue(draco::AttributeValueIndex(v), p.data());
  }
}

}  // namespace

std::string EncodeDraco(const TriangleMesh& mesh, Precision precision) {
  draco::Mesh encoded;
  encoded.set_num_points(mesh.NumVertices());
  encoded.SetNumFaces(mesh.NumFaces());
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    draco::Mesh::Face face;
    for (int i = 0; i < 3; ++i) face[i] = draco::PointIndex(mesh.faces[f][i]);
    encoded.SetFace(draco::FaceIndex(f), face);
  }
  if (precision == Precision::kDouble) {
    AddPositions<double>(mesh, draco::DT_FLOAT64, encoded);
  } else {
    AddPositions<float>(mesh, draco::DT_FLOAT32, encoded);
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
