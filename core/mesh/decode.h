// Draco bytes -> points and triangles, trusting nothing.
#ifndef MARROW_CORE_MESH_DECODE_H_
#define MARROW_CORE_MESH_DECODE_H_

#include <cstdint>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// What a payload may declare; anything above is refused before memory is
// allocated for it.
struct MeshLimits {
  uint64_t max_bytes = 64ull << 20;
  uint64_t max_faces = 4'000'000;
  uint64_t max_vertices = 2'000'000;
};

// The payload's own points and faces, in the order in which it decodes.
// Points split by attribute seams are still apart.
struct DecodedMesh {
  Positions positions;          // a row a point; finite
  std::vector<Triangle> faces;  // every index < positions.rows()
};

// Decodes a Draco triangle mesh (bitstream 2.0 to 2.2, edgebreaker or
// sequential) with one POSITION attribute of three 32- or 64-bit floats.
//
// The header is parsed and bounded by `limits` before Draco sees the bytes, and
// indices and coordinates are checked after. Errors are INVALID_ARGUMENT whose
// message names what is wrong and where (byte, point or face), and which carry
// the reason DRACO_DECODE_FAILED or MESH_REJECTED (core/base/error_reason.h);
// CANCELLED, but not while Draco decodes. Thread safe.
absl::StatusOr<DecodedMesh> DecodeDraco(
    std::string_view bytes, const MeshLimits& limits,
    const CancelToken& cancel = CancelToken());

}  // namespace marrow

#endif  // MARROW_CORE_MESH_DECODE_H_
