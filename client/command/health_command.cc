#include <cstdio>

#include "absl/strings/str_format.h"
#include "client/client.h"
#include "client/command/commands.h"
#include "client/command/exit_code.h"
#include "client/command/explain.h"

namespace marrow::client {
namespace {

constexpr absl::Duration kPatience = absl::Seconds(4);
constexpr char kDefaultServer[] = "127.0.0.1:50051";

}  // namespace

int RunHealth(const std::string& server) {
  const std::string address = server.empty() ? kDefaultServer : server;
  absl::StatusOr<std::unique_ptr<Client>> client =
      Client::Connect(address, kPatience);
  const absl::Status status =
      client.ok() ? (*client)->CheckHealth(kPatience) : client.status();
  if (status.ok()) {
    absl::PrintF("%s: serving\n", address);
    return kExitOk;
  }
  const std::string what =
      client.ok() ? Explain(status)
                  : absl::StrFormat(
                        "nothing answers (waited %s): start marrowd there, or "
                        "correct --server or MARROW_SERVER",
                        absl::FormatDuration(kPatience));
  absl::FPrintF(stderr, "marrow: %s: %s\n", address, what);
  return client.ok() ? kExitFailed : kExitUnreachable;
}

}  // namespace marrow::client
