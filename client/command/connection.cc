#include "client/command/connection.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "absl/time/clock.h"
#include "core/base/status_macros.h"
#include "server/server.h"

namespace marrow::client {
namespace {

constexpr absl::Duration kPatience = absl::Seconds(5);

class Remote : public Connection {
 public:
  explicit Remote(std::unique_ptr<Client> client)
      : client_(std::move(client)) {}
  Client& client() override { return *client_; }

 private:
  std::unique_ptr<Client> client_;
};

class Embedded : public Connection {
 public:
  explicit Embedded(std::unique_ptr<Server> server)
      : server_(std::move(server)), client_(server_->InProcessChannel()) {}
  Client& client() override { return client_; }

 private:
  std::unique_ptr<Server> server_;  // outlives the client
  Client client_;
};

absl::StatusOr<std::unique_ptr<Connection>> Embed(int threads) {
  ServerOptions options;
  options.listen.clear();
  options.compute_threads = threads;
  options.reflection = false;
  options.result_cache_bytes = 0;  // no file is asked for twice
  options.default_deadline = std::chrono::hours(24 * 365);
  MARROW_ASSIGN_OR_RETURN(std::unique_ptr<Server> server,
                          Server::Start(options));
  return std::make_unique<Embedded>(std::move(server));
}

}  // namespace

absl::StatusOr<std::unique_ptr<Connection>> Connect(
    const ConnectionOptions& options) {
  if (options.server.empty()) return Embed(options.threads);
  const absl::Duration patience = std::clamp(options.deadline - absl::Now(),
                                             absl::ZeroDuration(), kPatience);
  MARROW_ASSIGN_OR_RETURN(std::unique_ptr<Client> client,
                          Client::Connect(options.server, patience));
  return std::make_unique<Remote>(std::move(client));
}

}  // namespace marrow::client
