// What the services share, and what they owe to each call.
#ifndef MARROW_SERVER_SERVICE_CONTEXT_H_
#define MARROW_SERVER_SERVICE_CONTEXT_H_

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "marrow/v1/segmentation_service.pb.h"
#include "marrow/v1/spectrum_service.pb.h"
#include "server/compute_pool.h"
#include "server/engine.h"
#include "server/job.h"
#include "server/mesh_store.h"
#include "server/result_cache.h"
#include "server/server.h"
#include "server/spectrum_cache.h"
#include "server/ticker.h"

namespace marrow {

// Counts the calls under way. Thread safe.
class CallCounter {
 public:
  void Enter();
  void Leave();
  // False where calls are still under way after `limit`.
  bool WaitForNone(std::chrono::milliseconds limit);

 private:
  bool None() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) { return calls_ == 0; }

  absl::Mutex mu_;
  int calls_ ABSL_GUARDED_BY(mu_) = 0;
};

// Thread safe. Outlives all calls.
struct ServiceContext {
  ServiceContext(const ServerOptions& options, Engine engine);

  const ServerOptions options;
  const Engine engine;
  MeshStore store;
  SpectrumCache spectra;
  ResultCache results;
  JobTable<v1::SegmentEvent> segment_jobs;
  JobTable<v1::SpectrumEvent> spectrum_jobs;
  CallCounter calls;
  std::atomic<bool> draining{false};
  std::atomic<uint64_t> next_job{1};
  // The threads go first, since what they run uses all above.
  Ticker ticker;
  ComputePool pool;
  // For what no solver is needed for, and should not wait for one.
  ComputePool quick_pool;
};

// One call, from its arrival to its end: counted, logged, and given a deadline
// where it has none. Thread safe, but for Describe().
class CallRecord {
 public:
  CallRecord(ServiceContext& context, grpc::CallbackServerContext& call,
             std::string method);
  ~CallRecord();
  CallRecord(const CallRecord&) = delete;
  CallRecord& operator=(const CallRecord&) = delete;

  Clock::time_point arrived() const { return arrived_; }

  // Whether the server has to end the call; the client's own deadline is
  // watched by gRPC.
  bool Expired(Clock::time_point now) const { return now >= deadline_; }

  // Adds a field to the log line that Finished() writes.
  void Describe(std::string name, std::string value);

  // Logs the call.
  void Finished(const grpc::Status& status);

 private:
  ServiceContext& context_;
  const Clock::time_point arrived_ = Clock::now();
  Clock::time_point deadline_ = Clock::time_point::max();
  LogRecord log_;
};

// Error of a call that took longer than the server's default.
absl::Status DefaultDeadlineExceeded(const ServerOptions& options);

// Error of a call whose client is gone.
absl::Status CallCancelled();

}  // namespace marrow

#endif  // MARROW_SERVER_SERVICE_CONTEXT_H_
