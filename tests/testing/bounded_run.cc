#include "tests/testing/bounded_run.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <iostream>
#include <mutex>
#include <thread>

#include "core/spectrum/solver.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/cpu_time.h"
#include "tests/testing/invariants.h"

namespace marrow {
namespace {

constexpr uint32_t kMaxCheckedFaces = 30'000;

// Cancels the token unless it is destroyed in time.
class Watchdog {
 public:
  Watchdog(CancelToken& token, double seconds)
      : thread_([this, &token, seconds] {
          std::unique_lock lock(mutex_);
          if (!wake_.wait_for(lock, std::chrono::duration<double>(seconds),
                              [this] { return done_; }))
            token.Cancel();
        }) {}
  ~Watchdog() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::thread thread_;
};

// The process' memory at its peak since the last reset.
void ResetPeak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}
double PeakGibibytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kibibytes = 0;
      status >> kibibytes;
      return kibibytes / (1 << 20);
    }
  return 0;
}

void ExpectSoundRun(const RecordingSink& run, bool merged, size_t faces,
                    size_t points) {
  for (const auto& level : run.levels) {
    ASSERT_EQ(level.face_labels.size(), faces);
    ASSERT_EQ(level.point_labels.size(), points);
    for (uint32_t label : level.face_labels)
      ASSERT_LT(label, run.tree.nodes.size());
  }
  const TriangleMesh& mesh = run.mesh.mesh;
  if (mesh.NumFaces() > kMaxCheckedFaces) return;
  const Adjacency adjacency(mesh);
  ExpectSoundTree(mesh, adjacency, run.tree, run.mesh.report.area, true,
                  merged);
  for (const auto& level : run.levels)
    ExpectSoundSkeleton(mesh, adjacency, run.tree, level.level, level.skeleton);
}

}  // namespace

double MaxSeconds() { return Allowed(20); }

BoundedRun RunWithinBounds(std::string_view draco_bytes,
                           const SegmentationOptions& options) {
  SolverEigenPairSource solver;
  CancelToken cancel;
  BoundedRun run;
  run.merged = options.method == Method::kMerge;
  ResetPeak();
  const double cpu_begin = CpuSeconds();
  const auto begin = std::chrono::steady_clock::now();
  {
    const Watchdog watchdog(cancel, 3 * MaxSeconds());
    run.status =
        Run(draco_bytes, MeshLimits(), options, solver, cancel, run.sink);
  }
  const std::chrono::duration<double> wall =
      std::chrono::steady_clock::now() - begin;
  run.seconds = std::min(wall.count(), CpuSeconds() - cpu_begin);
  const double gibibytes = PeakGibibytes();
  EXPECT_LE(run.seconds, MaxSeconds());
  if (!kSanitized) {
    EXPECT_LE(gibibytes, kMaxGibibytes);
  }
  std::cout << run.seconds << " s, " << gibibytes << " GiB\n";
  return run;
}

Outcome Segments(uint32_t least, uint32_t most) {
  return {least, most, "", ""};
}
Outcome Refused(const std::string& word, const std::string& reason) {
  return {0, 0, word, reason};
}

void ExpectOutcome(const Outcome& outcome, const BoundedRun& run, size_t faces,
                   size_t points) {
  if (outcome.most == 0) {
    EXPECT_EQ(run.status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(ReasonOf(run.status), outcome.reason) << run.status;
    EXPECT_THAT(std::string(run.status.message()),
                ::testing::HasSubstr(outcome.word));
    EXPECT_TRUE(run.sink.events.empty());
    return;
  }
  ASSERT_TRUE(run.status.ok())
      << run.status << " at " << run.sink.fractions.back() << " of the run";
  const SegmentTree& tree = run.sink.tree;
  const uint32_t finest = run.sink.levels.back().level;
  const size_t segments = tree.SegmentsAtLevel(finest).size();
  std::cout << tree.SegmentsAtLevel(1).size() << " segments of level 1, "
            << segments << " of level " << finest << "\n";
  EXPECT_GE(segments, outcome.least);
  EXPECT_LE(segments, outcome.most);
  ExpectSoundRun(run.sink, run.merged, faces, points);
}

}  // namespace marrow
