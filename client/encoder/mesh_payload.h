// A mesh file -> what is sent to the server and what the user's file holds.
#ifndef MARROW_CLIENT_ENCODER_MESH_PAYLOAD_H_
#define MARROW_CLIENT_ENCODER_MESH_PAYLOAD_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/encoder/encode.h"
#include "client/polygon_mesh.h"
#include "core/mesh/decode.h"

namespace marrow {

struct MeshPayload {
  PolygonMesh mesh;  // in the file's order
  EncodedMesh encoded;
  bool sent_as_it_is = false;  // a Draco file, for which no option counts
};

// For Draco bytes: they are sent as they are, and the order of the file is that
// in which they decode. Errors are those of DecodeDraco.
absl::StatusOr<MeshPayload> PayloadFromDraco(std::string bytes,
                                             const MeshLimits& limits);

// Reads any mesh file and encodes it; one that holds Draco bytes is taken as it
// is. Errors are those of ReadMeshFile, EncodeMesh and PayloadFromDraco, and
// begin with the path; and DEADLINE_EXCEEDED, which is noticed while reading,
// and after parsing and encoding.
absl::StatusOr<MeshPayload> LoadMeshPayload(
    const std::string& path, const EncodeOptions& options,
    const MeshLimits& limits, absl::Time deadline = absl::InfiniteFuture());

}  // namespace marrow

#endif  // MARROW_CLIENT_ENCODER_MESH_PAYLOAD_H_
