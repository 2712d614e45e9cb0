// Log records as lines of JSON on stderr.
#ifndef MARROW_SERVER_JSON_LOG_H_
#define MARROW_SERVER_JSON_LOG_H_

#include <memory>
#include <string>

#include "server/log.h"

namespace spdlog {
class logger;
}

namespace marrow {

// One JSON object without line breaks: time (UTC, RFC 3339), level, message,
// the fields, seconds. Bytes that are not UTF-8 are replaced, and a very long
// value is cut.
std::string ToJsonLine(const LogRecord& record, const std::string& time);

// Thread safe.
class JsonLog {
 public:
  // `level` is the least that is written: trace, debug, info, warning, error,
  // off.
  explicit JsonLog(const std::string& level);

  void Write(const LogRecord& record);

 private:
  const std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_JSON_LOG_H_
