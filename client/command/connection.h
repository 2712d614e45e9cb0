// The service that a command talks to: far away, or in this process.
#ifndef MARROW_CLIENT_COMMAND_CONNECTION_H_
#define MARROW_CLIENT_COMMAND_CONNECTION_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/client.h"

namespace marrow::client {

struct ConnectionOptions {
  std::string server;  // empty: the service runs in this process
  int threads = 0;     // of the service in this process; 0: one a core
  absl::Time deadline = absl::InfiniteFuture();
};

// Owns the client and, where there is one, the service in this process. Both
// modes run the same code. Thread safe as Client is.
class Connection {
 public:
  virtual ~Connection() = default;
  virtual Client& client() = 0;
};

// Errors: UNAVAILABLE where the server does not answer within a few seconds, or
// by the deadline.
absl::StatusOr<std::unique_ptr<Connection>> Connect(
    const ConnectionOptions& options);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_CONNECTION_H_
