// What the service reports about itself, and to whom.
#ifndef MARROW_SERVER_LOG_H_
#define MARROW_SERVER_LOG_H_

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace marrow {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

// `fields` are names and values, neither escaped.
struct LogRecord {
  LogLevel level = LogLevel::kInfo;
  std::string message;
  std::vector<std::pair<std::string, std::string>> fields;
};

// Called on many threads at a time; must not block for long.
using LogFunction = std::function<void(const LogRecord&)>;

}  // namespace marrow

#endif  // MARROW_SERVER_LOG_H_
