// Failures in the words of the command line.
#ifndef MARROW_CLIENT_COMMAND_EXPLAIN_H_
#define MARROW_CLIENT_COMMAND_EXPLAIN_H_

#include <nlohmann/json.hpp>
#include <string>

#include "absl/status/status.h"

namespace marrow::client {

// The message for a person, without a full stop. A field of a request becomes
// the option that sets it: options.kappa is --kappa.
std::string Explain(const absl::Status& status);

// Explain(), with `file` before it where the message does not begin with it.
std::string ExplainFor(const std::string& file, const absl::Status& status);

// The exit code of a command that ends with `status`.
int ExitCodeOf(const absl::Status& status);

// Whether every other file of the same command would fail as well: an option
// has a value that no mesh allows, or the server is gone.
bool ConcernsAllFiles(const absl::Status& status);

// {event: "error", code, message, and reason and field where there are}.
nlohmann::json ErrorJson(const absl::Status& status);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_EXPLAIN_H_
