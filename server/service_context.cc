#include "server/service_context.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/time.h"

namespace marrow {
namespace {

int ComputeThreads(const ServerOptions& options) {
  if (options.compute_threads > 0) return options.compute_threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

LogLevel LevelOf(const grpc::Status& status) {
  switch (status.error_code()) {
    case grpc::StatusCode::INTERNAL:
    case grpc::StatusCode::UNKNOWN:
      return LogLevel::kError;
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return LogLevel::kWarning;
    default:
      return LogLevel::kInfo;
  }
}

}  // namespace

void CallCounter::Enter() {
  absl::MutexLock lock(&mu_);
  ++calls_;
}

void CallCounter::Leave() {
  absl::MutexLock lock(&mu_);
  --calls_;
}

bool CallCounter::WaitForNone(std::chrono::milliseconds limit) {
  absl::MutexLock lock(&mu_);
  return mu_.AwaitWithTimeout(absl::Condition(this, &CallCounter::None),
                              absl::FromChrono(limit));
}

ServiceContext::ServiceContext(const ServerOptions& server_options,
                               Engine server_engine)
    : options(server_options),
      engine(std::move(server_engine)),
      store(options.mesh_store_bytes),
      spectra(engine.solver, options.cache_bytes),
      results(options.result_cache_bytes),
      pool(ComputeThreads(options), options.max_queued_jobs),
      quick_pool(ComputeThreads(options), options.max_queued_jobs) {}

CallRecord::CallRecord(ServiceContext& context,
                       grpc::CallbackServerContext& call, std::string method)
    : context_(context) {
  if (call.deadline() == std::chrono::system_clock::time_point::max()) {
    deadline_ = arrived_ + context.options.default_deadline;
  }
  log_.message = "call";
  Describe("method", std::move(method));
  context_.calls.Enter();
}

CallRecord::~CallRecord() { context_.calls.Leave(); }

void CallRecord::Describe(std::string name, std::string value) {
  log_.fields.emplace_back(std::move(name), std::move(value));
}

void CallRecord::Finished(const grpc::Status& status) {
  if (!context_.options.log) return;
  log_.seconds = std::chrono::duration<double>(Clock::now() - arrived_).count();
  Describe("code", absl::StatusCodeToString(
                       static_cast<absl::StatusCode>(status.error_code())));
  if (!status.ok()) Describe("error", status.error_message());
  log_.level = LevelOf(status);
  context_.options.log(log_);
}

absl::Status DefaultDeadlineExceeded(const ServerOptions& options) {
  return absl::DeadlineExceededError(absl::StrCat(
      "the call set no deadline and took more than the server's default of ",
      options.default_deadline.count() / 1000,
      " s; set a longer deadline on the call"));
}

absl::Status CallCancelled() {
  return absl::CancelledError("the call was cancelled or its deadline passed");
}

}  // namespace marrow
