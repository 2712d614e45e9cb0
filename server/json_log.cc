#include "server/json_log.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "absl/time/clock.h"
#include "absl/time/time.h"

namespace marrow {
namespace {

constexpr size_t kMaxValueBytes = 1024;

const char* NameOf(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return "debug";
    case LogLevel::kInfo:
      return "info";
    case LogLevel::kWarning:
      return "warning";
    case LogLevel::kError:
      return "error";
  }
  return "info";
}

std::string Cut(const std::string& value) {
  return value.substr(0, kMaxValueBytes);
}

// The least LogLevel, as a number, that a --log-level lets through.
int LeastOf(const std::string& level) {
  for (const LogLevel each : {LogLevel::kDebug, LogLevel::kInfo,
                              LogLevel::kWarning, LogLevel::kError}) {
    if (level == NameOf(each)) return static_cast<int>(each);
  }
  return level == "trace" ? 0 : std::numeric_limits<int>::max();
}

std::string LineNow(const LogRecord& record) {
  return ToJsonLine(record,
                    absl::FormatTime("%Y-%m-%dT%H:%M:%E3SZ", absl::Now(),
                                     absl::UTCTimeZone())) +
         "\n";
}

std::string NoteOf(uint64_t dropped) {
  return LineNow({LogLevel::kWarning,
                  "log lines were dropped, as nobody read them",
                  {{"dropped", std::to_string(dropped)}},
                  {}});
}

}  // namespace

std::string ToJsonLine(const LogRecord& record, const std::string& time) {
  nlohmann::ordered_json line;
  line["time"] = time;
  line["level"] = NameOf(record.level);
  line["message"] = Cut(record.message);
  for (const auto& [name, value] : record.fields) line[name] = Cut(value);
  if (record.seconds.has_value()) line["seconds"] = *record.seconds;
  return line.dump(-1, ' ', true,
                   nlohmann::ordered_json::error_handler_t::replace);
}

JsonLog::JsonLog(const std::string& level, int fd)
    : least_(LeastOf(level)), writer_(fd, &NoteOf) {}

void JsonLog::Write(const LogRecord& record) {
  if (static_cast<int>(record.level) < least_) return;
  writer_.Write(LineNow(record));
}

}  // namespace marrow
