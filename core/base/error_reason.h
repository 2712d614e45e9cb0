// The machine-readable reason that travels with a failed status.
//
// A reason is a payload of the absl::Status, so that core needs no gRPC to
// give one; server/status.cc turns it into google.rpc.ErrorInfo.
#ifndef MARROW_CORE_BASE_ERROR_REASON_H_
#define MARROW_CORE_BASE_ERROR_REASON_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace marrow {

inline constexpr char kReasonDracoDecodeFailed[] = "DRACO_DECODE_FAILED";
inline constexpr char kReasonMeshRejected[] = "MESH_REJECTED";
inline constexpr char kReasonInvalidParameter[] = "INVALID_PARAMETER";
inline constexpr char kReasonSolverNotConverged[] = "SOLVER_NOT_CONVERGED";
inline constexpr char kReasonMeshMissing[] = "MESH_MISSING";
inline constexpr char kReasonNotCached[] = "NOT_CACHED";
inline constexpr char kReasonDigestMismatch[] = "DIGEST_MISMATCH";
inline constexpr char kReasonOverloaded[] = "OVERLOADED";
inline constexpr char kReasonDraining[] = "DRAINING";

// Attaches a reason to a status that is not OK.
absl::Status WithReason(absl::Status status, std::string_view reason);

// INVALID_ARGUMENT about one field of the request, such as "options.kappa".
absl::Status InvalidField(std::string_view field, std::string_view description);

// Empty where there is none.
std::string ReasonOf(const absl::Status& status);
std::string FieldOf(const absl::Status& status);

}  // namespace marrow

#endif  // MARROW_CORE_BASE_ERROR_REASON_H_
