// How soon work stops once it is cancelled, wherever it is.
#ifndef MARROW_TESTS_TESTING_SLOWEST_STOP_H_
#define MARROW_TESTS_TESTING_SLOWEST_STOP_H_

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <thread>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "gtest/gtest.h"
#include "tests/testing/cpu_time.h"

namespace marrow {

using CancellableWork = std::function<absl::Status(const CancelToken&)>;

// For how long `work` goes on, cancelled at `delay` seconds of its own; nothing
// where it is done before that. Seconds are those of a processor, so that they
// hold on a busy machine too. Fails the test where work that was cancelled
// tells of anything else.
inline std::optional<double> StopAfter(double delay,
                                       const CancellableWork& work) {
  CancelToken cancel;
  std::atomic<bool> done{false};
  double cancelled_at = 0;
  const double begin = CpuSeconds();
  std::thread canceller([&] {
    while (CpuSeconds() - begin < delay && !done)
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    cancelled_at = CpuSeconds();
    cancel.Cancel();
  });
  const absl::Status status = work(cancel);
  const double stopped_at = CpuSeconds();
  done = true;
  canceller.join();
  if (status.ok()) return std::nullopt;
  EXPECT_EQ(status.code(), absl::StatusCode::kCancelled) << status;
  return stopped_at - cancelled_at;
}

// Runs `work` again and again, cancelled a little later each time, until it is
// done before that: at `step` seconds of its work, at two ... at `most` at the
// latest. The longest that it went on for. Where that is longer than `limit` it
// is tried again, and the least counts: the thread that cancels may have been
// kept waiting by other processes, though not at one place every time.
inline double SlowestStop(double limit, double step, double most,
                          const CancellableWork& work) {
  constexpr int kMostTries = 4;
  double slowest = 0;
  int stops = 0;
  for (double delay = step; delay < most; delay += step) {
    std::optional<double> least;
    for (int i = 0; i < kMostTries && (i == 0 || *least >= limit); ++i) {
      const std::optional<double> stop = StopAfter(delay, work);
      if (!stop) break;
      least = std::min(least.value_or(*stop), *stop);
    }
    if (!least) break;
    ++stops;
    slowest = std::max(slowest, *least);
  }
  EXPECT_GT(stops, 0) << "done before it could be cancelled";
  return slowest;
}

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_SLOWEST_STOP_H_
