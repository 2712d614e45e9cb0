#include "server/json_log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

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

JsonLog::JsonLog(const std::string& level)
    : logger_(std::make_shared<spdlog::logger>(
          "marrow", std::make_shared<spdlog::sinks::stderr_sink_mt>())) {
  logger_->set_pattern("%v");
  logger_->set_level(spdlog::level::from_str(level));
}

void JsonLog::Write(const LogRecord& record) {
  const auto level = spdlog::level::from_str(NameOf(record.level));
  if (!logger_->should_log(level)) return;
  const std::string time = absl::FormatTime("%Y-%m-%dT%H:%M:%E3SZ", absl::Now(),
                                            absl::UTCTimeZone());
  logger_->log(level, "{}", ToJsonLine(record, time));
}

}  // namespace marrow
