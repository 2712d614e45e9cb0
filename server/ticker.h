// A slow clock that those who must act without being called listen to:
// progress, deadlines, stalled streams.
#ifndef MARROW_SERVER_TICKER_H_
#define MARROW_SERVER_TICKER_H_

#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace marrow {

using Clock = std::chrono::steady_clock;

class Tickable {
 public:
  virtual ~Tickable() = default;
  // Must not block.
  virtual void Tick(Clock::time_point now) = 0;
};

// Calls every listener a few times a second, on one thread, until the listener
// is destroyed. Thread safe.
class Ticker {
 public:
  Ticker();
  ~Ticker();
  Ticker(const Ticker&) = delete;
  Ticker& operator=(const Ticker&) = delete;

  void Add(std::weak_ptr<Tickable> listener);

 private:
  void Run();
  std::vector<std::shared_ptr<Tickable>> Listeners();

  absl::Mutex mu_;
  std::vector<std::weak_ptr<Tickable>> listeners_ ABSL_GUARDED_BY(mu_);
  bool stopping_ ABSL_GUARDED_BY(mu_) = false;
  std::thread thread_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_TICKER_H_
