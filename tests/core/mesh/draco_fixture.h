// Meshes made in code, and their Draco files.
#ifndef MARROW_TESTS_CORE_MESH_DRACO_FIXTURE_H_
#define MARROW_TESTS_CORE_MESH_DRACO_FIXTURE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/mesh/decode.h"

namespace marrow {

// A closed torus, rows x columns quads cut in two; vertices, faces and
// positions are all different and exact in 32 bits.
DecodedMesh Torus(uint32_t rows, uint32_t columns);

struct EncodeOptions {
  bool edgebreaker = true;
  int speed = 5;
  // Texture coordinates and normals that differ on the two sides of many edges.
  bool seams = false;
  bool double_precision = false;
  int quantization_bits = 0;  // 0: lossless
};

// Fails the test where Draco refuses.
std::string EncodeDraco(const DecodedMesh& mesh, const EncodeOptions& options);

}  // namespace marrow

#endif  // MARROW_TESTS_CORE_MESH_DRACO_FIXTURE_H_
