// The whole service in one object: what marrowd runs, and what the client
// embeds where it is given no server.
#ifndef MARROW_SERVER_SERVER_H_
#define MARROW_SERVER_SERVER_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "core/mesh/decode.h"
#include "server/log.h"

namespace marrow {

struct Engine;

inline constexpr char kVersion[] = "0.1.0";

struct ServerOptions {
  // HOST:PORT to listen on; port 0 takes a free one. Empty: no socket at all,
  // InProcessChannel() is the only way in.
  std::string listen = "127.0.0.1:50051";
  MeshLimits mesh_limits;
  uint64_t max_inline_mesh_bytes = 1ull << 20;  // at most 1 MiB
  uint64_t cache_bytes = 1ull << 30;            // eigen-pairs
  uint64_t result_cache_bytes = 1ull << 30;     // what Cut answers from
  // Uploaded payloads; at least mesh_limits.max_bytes.
  uint64_t mesh_store_bytes = 1ull << 30;
  int compute_threads = 0;   // 0: one a core
  int max_queued_jobs = 64;  // beyond them: UNAVAILABLE
  bool reflection = true;
  // How long a call may take whose client sets no deadline.
  std::chrono::milliseconds default_deadline = std::chrono::minutes(10);
  // A stream whose client reads nothing for so long is ended.
  std::chrono::milliseconds write_stall_limit = std::chrono::seconds(60);
  // An upload slower than 1 KiB/s is ended after so long.
  std::chrono::milliseconds upload_stall_limit = std::chrono::seconds(30);
  // Longest silence of a stream whose work goes on.
  std::chrono::milliseconds progress_interval = std::chrono::seconds(5);
  LogFunction log;  // none: silent
};

// Thread safe.
class Server {
 public:
  // Errors: UNAVAILABLE where the address cannot be bound, INVALID_ARGUMENT
  // for an impossible option.
  static absl::StatusOr<std::unique_ptr<Server>> Start(
      const ServerOptions& options);
  // The same on another engine (server/engine.h), for tests.
  static absl::StatusOr<std::unique_ptr<Server>> Start(
      const ServerOptions& options, Engine engine);
  // Shuts down, cancelling what still runs.
  virtual ~Server() = default;

  // The port that is listened on; 0 without a socket.
  virtual int port() const = 0;

  virtual std::shared_ptr<grpc::Channel> InProcessChannel() = 0;

  // Answers NOT_SERVING to health checks and UNAVAILABLE (DRAINING) to new
  // calls, lets running calls finish until `grace` is over, cancels the rest
  // and returns when all are gone. Idempotent.
  virtual void Drain(std::chrono::milliseconds grace) = 0;
};

}  // namespace marrow

#endif  // MARROW_SERVER_SERVER_H_
