// What the service reports about itself, and to whom.
#ifndef MARROW_SERVER_LOG_H_
#define MARROW_SERVER_LOG_H_

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace marrow {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

// `fields` are names and values, neither escaped, of any bytes.
struct LogRecord {
  LogLevel level = LogLevel::kInfo;
  std::string message;
  std::vector<std::pair<std::string, std::string>> fields;
  std::optional<double> seconds;  // that what is reported took
};

// Called on many threads at a time; must not block for long.
using LogFunction = std::function<void(const LogRecord&)>;

}  // namespace marrow

#endif  // MARROW_SERVER_LOG_H_
