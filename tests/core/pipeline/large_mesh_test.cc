// Meshes so large that they are computed on a coarse one.
#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "core/operators/bodies.h"
#include "core/pipeline/pipeline.h"
#include "gtest/gtest.h"
#include "tests/testing/invariants.h"
#include "tests/testing/run.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// A body with four limbs; a little above kLargeBody vertices.
TriangleMesh LargeCross() { return LimbCross(24); }

class LargeMeshTest : public testing::TestWithParam<Method> {
 protected:
  static RecordingSink Segment(const TriangleMesh& mesh) {
    SegmentationOptions options;
    options.method = GetParam();
    options.levels = 2;
    return RunOn(mesh, options);
  }

  static void ExpectSound(const RecordingSink& result) {
    const Adjacency adjacency(result.mesh.mesh);
    ExpectSoundTree(result.mesh.mesh, adjacency, result.tree,
                    result.mesh.report.area, true,
                    GetParam() == Method::kMerge);
    for (const RecordingSink::Level& level : result.levels)
      ExpectSoundSkeleton(result.mesh.mesh, adjacency, level.tree, level.level,
                          level.skeleton);
  }
};

TEST_P(LargeMeshTest, IsSegmentedAsASmallOneIs) {
  const RecordingSink large = Segment(LargeCross());
  ASSERT_GT(large.mesh.report.vertices, kLargeBody);
  EXPECT_EQ(large.mesh.report.coarse_vertices, kCoarseVertices);
  ExpectSound(large);
  const RecordingSink small = Segment(LimbCross(12));
  EXPECT_EQ(small.mesh.report.coarse_vertices, 0u);
  EXPECT_EQ(large.levels[0].tree.SegmentsAtLevel(1).size(),
            small.levels[0].tree.SegmentsAtLevel(1).size());

  const auto cut = large.segmented->Cut(CutSpec::Into(3), CancelToken());
  ASSERT_TRUE(cut.ok()) << cut.status();
  std::map<uint32_t, std::vector<uint32_t>> faces;
  for (uint32_t f = 0; f < large.mesh.face_map.size(); ++f)
    faces[cut->face_labels[f]].push_back(large.mesh.face_map[f]);
  for (const CutResult::Segment& segment : cut->segments) {
    const std::vector<uint32_t> own =
        VerticesOf(large.mesh.mesh, faces[segment.id]);
    ASSERT_FALSE(segment.medial_structure.empty());
    EXPECT_TRUE(std::includes(own.begin(), own.end(),
                              segment.medial_structure.begin(),
                              segment.medial_structure.end()));
  }
}

TEST_P(LargeMeshTest, MayBeOneBodyOfSeveral) {
  const RecordingSink both = Segment(Apart(LargeCross(), Icosphere(4)));
  EXPECT_EQ(both.mesh.report.bodies, 2u);
  EXPECT_EQ(both.mesh.report.coarse_vertices, kCoarseVertices);
  EXPECT_EQ(both.mesh.report.body_vertices, kCoarseVertices + 2'562);
  ExpectSound(both);
}

INSTANTIATE_TEST_SUITE_P(Methods, LargeMeshTest,
                         testing::Values(Method::kPaper, Method::kMerge),
                         [](const auto& info) {
                           return info.param == Method::kPaper ? "Paper"
                                                               : "Merge";
                         });

}  // namespace
}  // namespace marrow
