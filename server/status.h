// The one place where absl::Status becomes grpc::Status.
#ifndef MARROW_SERVER_STATUS_H_
#define MARROW_SERVER_STATUS_H_

#include <grpcpp/grpcpp.h>

#include "absl/status/status.h"
#include "core/base/digest.h"

namespace marrow {

// FAILED_PRECONDITION with reason MESH_MISSING.
absl::Status MeshMissing(const Digest& sha256);

// NOT_FOUND with reason NOT_CACHED.
absl::Status NotCached(const Digest& sha256);

// UNAVAILABLE with reason DRAINING.
absl::Status Draining();

// The same code; the message, shortened where it is very long; and as details
// exactly one ErrorInfo, with BadRequest, PreconditionFailure or RetryInfo
// where the reason asks for it (proto/marrow/v1/error_details.proto). A status
// without a reason gets its code's name as reason.
grpc::Status ToGrpcStatus(const absl::Status& status);

}  // namespace marrow

#endif  // MARROW_SERVER_STATUS_H_
