// What comes before the solver stops soon after it is cancelled, wherever it
// is: from bytes to bodies.
#include <limits>
#include <string>
#include <utility>

#include "core/base/status_macros.h"
#include "core/mesh/canonical_mesh.h"
#include "core/mesh/decode.h"
#include "core/operators/bodies.h"
#include "gtest/gtest.h"
#include "tests/testing/draco_encode.h"
#include "tests/testing/shapes.h"
#include "tests/testing/slowest_stop.h"

namespace marrow {
namespace {

const double kMostSeconds = Allowed(0.1);
constexpr double kUntilDone = std::numeric_limits<double>::infinity();

absl::Status FindBodiesOf(const std::string& bytes, const CancelToken& cancel) {
  MARROW_ASSIGN_OR_RETURN(const DecodedMesh decoded,
                          DecodeDraco(bytes, MeshLimits(), cancel));
  MARROW_ASSIGN_OR_RETURN(CanonicalMesh mesh, Canonicalize(decoded, cancel));
  (void)FindBodies(mesh, cancel);
  return cancel.Check();
}

double SlowestStopOf(const TriangleMesh& mesh, double step) {
  const std::string bytes = EncodeDraco(mesh);
  return SlowestStop(
      kMostSeconds, step, kUntilDone,
      [&](const CancelToken& cancel) { return FindBodiesOf(bytes, cancel); });
}

// 400,000 vertices, which become fewer.
TEST(MeshCancellationTest, OneLargeShell) {
  EXPECT_LT(SlowestStopOf(Torus(3, 1, 1000, 400), 0.19), kMostSeconds);
}

// Rims all around: cracks are looked for, and seams, and bridges.
TEST(MeshCancellationTest, ShellsWithRims) {
  TriangleMesh upper = Grid(300, 300);
  upper.positions.col(2).array() += 2;
  EXPECT_LT(SlowestStopOf(Apart(Grid(300, 300), upper), 0.13), kMostSeconds);
}

}  // namespace
}  // namespace marrow
