// How soon work stops once it is cancelled, wherever it is.
#ifndef MARROW_TESTS_TESTING_SLOWEST_STOP_H_
#define MARROW_TESTS_TESTING_SLOWEST_STOP_H_

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "gtest/gtest.h"
#include "tests/testing/cpu_time.h"

namespace marrow {

// Runs `work` again and again, cancelled a little later each time, until it is
// done before that: at `step` seconds of its work, at two ... at `most` at the
// latest. The longest that it went on for, in seconds of a processor, so that
// it holds on a busy machine too. Fails the test where work that was cancelled
// tells of anything else.
inline double SlowestStop(
    double step, double most,
    const std::function<absl::Status(const CancelToken&)>& work) {
  double slowest = 0;
  int stops = 0;
  for (double delay = step; delay < most; delay += step) {
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
    if (status.ok()) break;
    EXPECT_EQ(status.code(), absl::StatusCode::kCancelled) << status;
    ++stops;
    slowest = std::max(slowest, stopped_at - cancelled_at);
  }
  EXPECT_GT(stops, 0) << "done before it could be cancelled";
  return slowest;
}

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_SLOWEST_STOP_H_
