// A failed call, in a person's words.
#ifndef MARROW_CLIENT_RPC_STATUS_H_
#define MARROW_CLIENT_RPC_STATUS_H_

#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace marrow::client {

// The same code and message. The reason and the field at fault that the
// server attached are read by ReasonOf() and FieldOf()
// (core/base/error_reason.h). Details that do not parse are left out.
absl::Status FromRpcStatus(const grpc::Status& status);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_RPC_STATUS_H_
