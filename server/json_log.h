// Log records as lines of JSON.
#ifndef MARROW_SERVER_JSON_LOG_H_
#define MARROW_SERVER_JSON_LOG_H_

#include <unistd.h>

#include <string>

#include "absl/time/time.h"
#include "server/line_writer.h"
#include "server/log.h"

namespace marrow {

// One JSON object without line breaks: time (UTC, RFC 3339), level, message,
// the fields, seconds. Bytes that are not UTF-8 are replaced, and a very long
// value is cut.
std::string ToJsonLine(const LogRecord& record, const std::string& time);

// Thread safe.
class JsonLog {
 public:
  // `level` is the least that is written: trace, debug, info, warning, error,
  // off. `fd` stays the caller's.
  explicit JsonLog(const std::string& level, int fd = STDERR_FILENO);

  // Waits for no reader: lines are dropped while too many wait, and a line with
  // the field `dropped` tells how many once it can be written.
  void Write(const LogRecord& record);

  // Waits until all lines are written or `limit` is over; false in that case.
  bool Flush(absl::Duration limit) { return writer_.Flush(limit); }

 private:
  const int least_;
  LineWriter writer_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_JSON_LOG_H_
