// A whole run that is cancelled when it takes too long, and measured.
#ifndef MARROW_TESTS_TESTING_BOUNDED_RUN_H_
#define MARROW_TESTS_TESTING_BOUNDED_RUN_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "core/base/error_reason.h"
#include "core/pipeline/options.h"
#include "tests/testing/recording_sink.h"

namespace marrow {

// What any mesh may take. Sanitizers are given more.
double MaxSeconds();
inline constexpr double kMaxGibibytes = 4;

struct BoundedRun {
  absl::Status status;  // CANCELLED long after MaxSeconds()
  // By the clock or of processors, whichever is less: on an idle machine it
  // would take no longer than either.
  double seconds = 0;
  bool merged = false;  // by METHOD_MERGE
  RecordingSink sink;
};

// With the solver, a mesh within the default limits. Fails the test where the
// run takes more than MaxSeconds(), or the process more than kMaxGibibytes at
// its peak (but under sanitizers, which keep shadows).
BoundedRun RunWithinBounds(std::string_view draco_bytes,
                           const SegmentationOptions& options);

// What a table says that becomes of a mesh.
struct Outcome {
  // Segments of the finest level; 0 for a mesh that is refused.
  uint32_t least = 0;
  uint32_t most = 0;
  // Of the refusal: a part of its message, and its reason.
  std::string word;
  std::string reason;
};
Outcome Segments(uint32_t least, uint32_t most);
Outcome Refused(const std::string& word,
                const std::string& reason = kReasonMeshRejected);

// Fails the test unless the run of a payload with so many faces and points
// ended as the outcome says, and all invariants of its results hold. (Those
// that are slow to test are tested of meshes of up to 30,000 faces.)
void ExpectOutcome(const Outcome& outcome, const BoundedRun& run, size_t faces,
                   size_t points);

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_BOUNDED_RUN_H_
