// PolygonMesh -> Draco bytes, with the way back to the file's order.
#ifndef MARROW_CLIENT_ENCODER_ENCODE_H_
#define MARROW_CLIENT_ENCODER_ENCODE_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/encoder/order_map.h"
#include "client/polygon_mesh.h"

namespace marrow {

enum class EncodeMethod { kAuto, kEdgebreaker, kSequential };

// As many as a float has; each one more doubles Draco's tables, which take a
// gigabyte from 28 on.
inline constexpr int kMaxQuantizationBits = 24;

struct EncodeOptions {
  // kAuto takes edgebreaker, which is smaller, where it keeps every face and is
  // quick, and sequential otherwise: where a triangle has two corners at one
  // position, or vertices have so many faces that edgebreaker takes quadratic
  // time.
  EncodeMethod method = EncodeMethod::kAuto;
  int speed = 5;  // 0 (smallest) to 10 (quickest), both for encode and decode
  // Bits a coordinate, 1 to kMaxQuantizationBits; 0 sends the numbers as they
  // are: floats, or doubles where there is a coordinate that is no float. A
  // mesh with a coordinate that is not finite as a float is sent as it is in
  // any case.
  int quantization_bits = 0;
  bool keep_attributes = false;  // send texture coordinates and normals too
};

struct EncodedMesh {
  std::string bytes;
  EncodeMethod method = EncodeMethod::kSequential;  // never kAuto
  OrderMap order;
};

// Polygons are triangulated and vertices at one position (to the bit) become
// one; vertices without a face are left out, whatever their coordinates;
// nothing else is changed. Edgebreaker drops triangles with two corners at one
// position. Equal input gives equal bytes.
//
// Errors: INVALID_ARGUMENT where an option is out of range, no face has three
// corners, or the method that was asked for cannot represent the mesh;
// RESOURCE_EXHAUSTED where memory does not suffice. Thread safe.
absl::StatusOr<EncodedMesh> EncodeMesh(const PolygonMesh& mesh,
                                       const EncodeOptions& options);

}  // namespace marrow

#endif  // MARROW_CLIENT_ENCODER_ENCODE_H_
