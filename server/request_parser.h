// Requests -> checked values. Every error is INVALID_ARGUMENT and names the
// field, as "options.kappa".
#ifndef MARROW_SERVER_REQUEST_PARSER_H_
#define MARROW_SERVER_REQUEST_PARSER_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/hierarchy/cut.h"
#include "core/pipeline/options.h"
#include "marrow/v1/mesh.pb.h"
#include "marrow/v1/segmentation_service.pb.h"
#include "server/mesh_store.h"
#include "server/server.h"

namespace marrow {

struct Outputs {
  bool face_labels = false;
  bool point_labels = false;
  bool skeletons = true;
  std::set<uint32_t> levels;  // never empty
};

struct SegmentParameters {
  SegmentationOptions options;
  Outputs outputs;
  std::optional<CutSpec> cut;
};

absl::StatusOr<SegmentParameters> ParseSegmentParameters(
    const v1::SegmentRequest& request);

// `cut` is there. The mesh is parsed apart.
absl::StatusOr<SegmentParameters> ParseCutParameters(
    const v1::CutRequest& request);

// `field` is what the request calls the number; absent means the default.
absl::StatusOr<uint32_t> ParseEigenPairs(bool present, uint32_t value,
                                         const char* field);

// `field` is what the request calls the digest.
absl::StatusOr<MeshDigest> ParseMeshDigest(const v1::MeshDigest& digest,
                                           const std::string& field,
                                           const ServerOptions& limits);

struct Payload {
  MeshDigest digest;
  std::shared_ptr<const std::string> bytes;
};

// Finds the payload of a request in the store, or puts it there. Besides bad
// fields: FAILED_PRECONDITION with reason MESH_MISSING.
absl::StatusOr<Payload> ResolveMesh(bool present, const v1::MeshSource& source,
                                    const ServerOptions& limits,
                                    MeshStore& store);

}  // namespace marrow

#endif  // MARROW_SERVER_REQUEST_PARSER_H_
