// What becomes of every hostile mesh, as a table: so many segments, or which
// refusal. MARROW_HOSTILE=full runs the same table at full size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "core/base/error_reason.h"
#include "core/spectrum/solver.h"
#include "tests/testing/draco_encode.h"
#include "tests/testing/hostile_meshes.h"
#include "tests/testing/invariants.h"
#include "tests/testing/recording_sink.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
constexpr double kMaxSeconds = kSanitized ? 200 : 20;
constexpr double kMaxGibibytes = 4;
// What the invariants are tested on: their tests are plain, not quick.
constexpr uint32_t kMaxCheckedFaces = 30'000;

struct Outcome {
  // Segments of the finest level; 0 for a mesh that is refused.
  uint32_t least = 0;
  uint32_t most = 0;
  // Of the refusal.
  std::string word;
  std::string reason;
  uint32_t eigen_pairs = 200;
};

Outcome Segments(uint32_t least, uint32_t most, uint32_t eigen_pairs = 200) {
  return {least, most, "", "", eigen_pairs};
}
Outcome Refused(const std::string& word,
                const std::string& reason = kReasonMeshRejected) {
  return {0, 0, word, reason};
}

HostileSize SizeWanted() {
  const char* wanted = std::getenv("MARROW_HOSTILE");
  return wanted != nullptr && std::string(wanted) == "full"
             ? HostileSize::kFull
             : HostileSize::kReduced;
}

const std::map<std::string, Outcome>& Outcomes() {
  static const auto* outcomes = new std::map<std::string, Outcome>{
      {"c46_one_nan", Refused("point 7 is not finite")},
      {"c47_infinity", Refused("point 7 is not finite")},
      {"c47_minus_infinity", Refused("point 7 is not finite")},
      {"c48_all_minus_zero", Refused("degenerate")},
      {"c48_denormals", Segments(1, 60)},
      {"c49_1e30", Segments(5, 60)},
      {"c50_largest_floats", Segments(1, 60)},
      {"c50_plus_and_minus_largest_floats", Segments(1, 60)},
      {"c51_box_1e_30", Segments(5, 60)},
      {"c52_1e30_and_1e_30", Segments(1, 60)},
      {"c53_offset_1e7_in_floats", Segments(1, 60)},
      {"c53_offset_1e7_in_doubles", Segments(5, 60)},
      {"c54_identical_points", Refused("degenerate")},
      {"c55_collinear", Refused("zero")},
      {"c56_single_triangle", Segments(1, 1)},
      {"c57_single_degenerate", Refused("degenerate")},
      {"c58_every_second_face_flat", Segments(5, 60)},
      {"c59_slivers_1e_12", Segments(5, 60)},
      {"c60_halving_rings", Segments(1, 60)},
      {"c60_needles_and_caps", Segments(1, 60)},
      {"c61_duplicate_faces", Segments(5, 60)},
      {"c62_every_face_twice", Segments(5, 60)},
      {"c63_random_orientation", Segments(5, 60)},
      {"c64_edge_in_3_faces", Segments(3, 60)},
      {"c65_book", Segments(1, 100)},
      {"c66_bowtie", Segments(1, 60)},
      {"c67_cones", Segments(1, 100)},
      {"c68_fan", Segments(1, 100)},
      {"c69_bipyramid", Segments(1, 100)},
      {"c70_isolated_vertices", Segments(5, 60)},
      {"c70_too_many_isolated_vertices",
       Refused("leave out vertices that no face uses",
               kReasonDracoDecodeFailed)},
      {"c71_tetrahedra", Segments(1, 200)},
      {"c72_triangles", SizeWanted() == HostileSize::kFull
                            ? Refused("the limit is 2000000; simplify it")
                            : Segments(1, 200)},
      {"c72_most_triangles", Segments(1, 200)},
      {"c73_fewer_vertices_than_pairs", Segments(1, 1, 1000)},
      {"c73_fewer_pairs_than_components", Segments(1, 200, 100)},
      {"c74_moebius_strip", Segments(1, 60)},
      {"c74_klein_bottle", Segments(1, 60)},
      {"c75_genus_0", Segments(5, 60)},
      {"c75_genus_1", Segments(1, 60)},
      {"c75_genus_2", Segments(1, 60)},
      {"c75_genus_100", Segments(1, 200)},
      {"c75_genus_1000", Segments(1, 200)},
      {"c76_spindle_torus", Segments(1, 60)},
      {"c77_sheets_1e_9_apart", Segments(1, 60)},
      {"c78_disk", Segments(1, 60)},
      {"c78_annulus", Segments(1, 60)},
      {"c78_holes", Segments(1, 200)},
      {"c79_icosphere", Segments(1, 60)},
      {"c79_cube", Segments(1, 60)},
      {"c80_neck_1e_6", Segments(2, 60)},
      {"c81_hilbert_strip", Segments(2, 200)},
      {"c81_menger_sponge", Segments(1, 200)},
      {"c82_comb", Segments(2, 200)},
  };
  return *outcomes;
}

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

struct Result {
  absl::Status status;
  double seconds = 0;
  double gibibytes = 0;
};

Result RunWithin(const std::string& bytes, uint32_t eigen_pairs,
                 RecordingSink& sink) {
  SegmentationOptions options;
  options.eigen_pairs = eigen_pairs;
  SolverEigenPairSource solver;
  CancelToken cancel;
  ResetPeak();
  const auto begin = std::chrono::steady_clock::now();
  Result result;
  {
    const Watchdog watchdog(cancel, kMaxSeconds);
    result.status = Run(bytes, MeshLimits(), options, solver, cancel, sink);
  }
  const std::chrono::duration<double> elapsed =
      std::chrono::steady_clock::now() - begin;
  result.seconds = elapsed.count();
  result.gibibytes = PeakGibibytes();
  return result;
}

void ExpectSoundRun(const RecordingSink& run, size_t faces, size_t points) {
  for (const auto& level : run.levels) {
    ASSERT_EQ(level.face_labels.size(), faces);
    ASSERT_EQ(level.point_labels.size(), points);
    for (uint32_t label : level.face_labels)
      ASSERT_LT(label, run.tree.nodes.size());
  }
  const TriangleMesh& mesh = run.mesh.mesh;
  if (mesh.NumFaces() > kMaxCheckedFaces) return;
  const Adjacency adjacency(mesh);
  ExpectSoundTree(mesh, adjacency, run.tree, run.mesh.report.area, true);
  for (const auto& level : run.levels)
    ExpectSoundSkeleton(mesh, adjacency, run.tree, level.level, level.skeleton);
}

class HostileGeometryTest : public ::testing::TestWithParam<HostileMesh> {};

TEST_P(HostileGeometryTest, EndsAsTheTableSays) {
  const Outcome& expected = Outcomes().at(GetParam().name);
  TriangleMesh mesh = GetParam().make();
  const size_t faces = mesh.NumFaces(), points = mesh.NumVertices();
  const std::string bytes = EncodeDraco(mesh, Precision::kDouble);
  mesh = TriangleMesh();
  RecordingSink run;
  const Result result = RunWithin(bytes, expected.eigen_pairs, run);
  std::cout << points << " points, " << faces << " faces, " << result.seconds
            << " s, " << result.gibibytes << " GiB\n";
  EXPECT_LE(result.seconds, kMaxSeconds);
  if (!kSanitized) {
    EXPECT_LE(result.gibibytes, kMaxGibibytes);
  }
  if (expected.most == 0) {
    EXPECT_EQ(ReasonOf(result.status), expected.reason) << result.status;
    EXPECT_THAT(std::string(result.status.message()), HasSubstr(expected.word));
    EXPECT_TRUE(run.events.empty());
    return;
  }
  ASSERT_TRUE(result.status.ok()) << result.status;
  const size_t segments =
      run.tree.SegmentsAtLevel(run.levels.back().level).size();
  std::cout << run.tree.SegmentsAtLevel(1).size() << " segments of level 1, "
            << segments << " in all\n";
  EXPECT_GE(segments, expected.least);
  EXPECT_LE(segments, expected.most);
  ExpectSoundRun(run, faces, points);
}

INSTANTIATE_TEST_SUITE_P(All, HostileGeometryTest,
                         ::testing::ValuesIn(HostileMeshes(SizeWanted())),
                         [](const auto& info) { return info.param.name; });

TEST(HostileTableTest, HasEveryNumberAndNoOther) {
  std::map<std::string, int> rows, numbers;
  for (const HostileMesh& mesh : HostileMeshes(SizeWanted())) {
    ++rows[mesh.name];
    ++numbers[mesh.name.substr(0, 3)];
  }
  for (const auto& [name, outcome] : Outcomes())
    EXPECT_EQ(rows[name], 1) << name;
  EXPECT_EQ(rows.size(), Outcomes().size());
  EXPECT_EQ(numbers.begin()->first, "c46");
  EXPECT_EQ(numbers.rbegin()->first, "c82");
  EXPECT_EQ(numbers.size(), 37u);
}

}  // namespace
}  // namespace marrow
