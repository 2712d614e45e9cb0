#include "tests/testing/run.h"

#include <map>
#include <utility>

#include "core/spectrum/solver.h"
#include "gtest/gtest.h"
#include "tests/testing/draco_encode.h"

namespace marrow {

SegmentationOptions Levels(uint32_t levels, Method method) {
  SegmentationOptions options;
  options.method = method;
  options.eigen_pairs = 100;
  options.levels = levels;
  return options;
}

RecordingSink RunOn(const TriangleMesh& mesh,
                    const SegmentationOptions& options) {
  RecordingSink sink;
  SolverEigenPairSource solver;
  const CancelToken cancel;
  const absl::Status status =
      Run(EncodeDraco(mesh), MeshLimits(), options, solver, cancel, sink);
  EXPECT_TRUE(status.ok()) << status;
  return sink;
}

void ExpectSameTree(const SegmentTree& a, const SegmentTree& b) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (size_t i = 0; i < a.nodes.size(); ++i) {
    SCOPED_TRACE(::testing::Message() << "node " << i);
    const SegmentNode& x = a.nodes[i];
    const SegmentNode& y = b.nodes[i];
    EXPECT_EQ(x.parent, y.parent);
    EXPECT_EQ(x.level, y.level);
    EXPECT_EQ(x.area, y.area);
    EXPECT_EQ(x.centroid, y.centroid);
    EXPECT_EQ(x.medial_structure, y.medial_structure);
    EXPECT_EQ(x.faces, y.faces);
    EXPECT_EQ(x.children, y.children);
    EXPECT_EQ(x.iterations, y.iterations);
    EXPECT_EQ(x.salience, y.salience);
    EXPECT_EQ(x.stop_reason, y.stop_reason);
  }
}

void ExpectSameSkeleton(const Skeleton& a, const Skeleton& b) {
  ASSERT_EQ(a.joints.size(), b.joints.size());
  for (size_t j = 0; j < a.joints.size(); ++j) {
    EXPECT_EQ(a.joints[j].parent, b.joints[j].parent);
    EXPECT_EQ(a.joints[j].articulation, b.joints[j].articulation);
    EXPECT_EQ(a.joints[j].position, b.joints[j].position);
    EXPECT_EQ(a.joints[j].segments, b.joints[j].segments);
  }
}

double RandIndexDifference(const std::vector<uint32_t>& a,
                           const std::vector<uint32_t>& b) {
  std::map<uint32_t, double> in_a, in_b;
  std::map<std::pair<uint32_t, uint32_t>, double> in_both;
  for (size_t f = 0; f < a.size(); ++f) {
    ++in_a[a[f]];
    ++in_b[b[f]];
    ++in_both[{a[f], b[f]}];
  }
  auto squares = [](const auto& counts) {
    double sum = 0;
    for (const auto& [key, count] : counts) sum += count * count;
    return sum;
  };
  const double n = static_cast<double>(a.size());
  return (squares(in_a) + squares(in_b) - 2 * squares(in_both)) / (n * n);
}

}  // namespace marrow
