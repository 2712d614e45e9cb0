// The file's numbering cannot matter; rotation and scale change rounding alone.
#include <gtest/gtest.h>

#include <vector>

#include "tests/testing/run.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

SegmentationOptions FewPairs() {
  SegmentationOptions options;
  options.method = Method::kPaper;
  options.eigen_pairs = 60;
  return options;
}

class RenumberingOfAnyShape : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(RenumberingOfAnyShape, ChangesNothing) {
  const TriangleMesh& mesh = GetParam().mesh;
  const RecordingSink expected = RunOn(mesh, FewPairs());
  for (uint32_t seed : {1u, 2u}) {
    const Renumbering renumbering = Renumber(mesh, seed);
    const RecordingSink run = RunOn(renumbering.mesh, FewPairs());
    EXPECT_EQ(run.mesh.geometry_digest, expected.mesh.geometry_digest);
    ExpectSameTree(run.tree, expected.tree);
    ASSERT_EQ(run.levels.size(), expected.levels.size());
    for (size_t i = 0; i < run.levels.size(); ++i) {
      ExpectSameSkeleton(run.levels[i].skeleton, expected.levels[i].skeleton);
      for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
        ASSERT_EQ(run.levels[i].face_labels[f],
                  expected.levels[i].face_labels[renumbering.old_face[f]]);
      for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
        ASSERT_EQ(run.levels[i].point_labels[v],
                  expected.levels[i].point_labels[renumbering.old_vertex[v]]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, RenumberingOfAnyShape,
                         ::testing::ValuesIn(AllShapes()),
                         [](const auto& info) {
                           return TestNameOf(info.param);
                         });

TEST(EquivarianceTest, RotationAndScaleKeepThePartition) {
  const TriangleMesh mesh = LimbCross(4);
  const RecordingSink expected = RunOn(mesh, FewPairs());
  ASSERT_GE(expected.levels.size(), 2u);
  for (const TriangleMesh& other :
       {Rotated(mesh, {1, 2, 3}, 1.1), Rotated(mesh, {0, 1, 0}, 3),
        Scaled(mesh, 1e-12), Scaled(mesh, 3e15),
        Scaled(Rotated(mesh, {-1, 0, 2}, 2.2), 0.37)}) {
    const RecordingSink run = RunOn(other, FewPairs());
    ASSERT_EQ(run.levels.size(), expected.levels.size());
    for (size_t i = 0; i < 2; ++i)
      EXPECT_LE(RandIndexDifference(run.levels[i].face_labels,
                                    expected.levels[i].face_labels),
                0.01)
          << "level " << i + 1;
  }
}

TEST(RandIndexDifferenceTest, CountsPairs) {
  EXPECT_EQ(RandIndexDifference({1, 1, 2, 2}, {7, 7, 5, 5}), 0);
  // Of 16 ordered pairs, 8 are together in one and apart in the other.
  EXPECT_DOUBLE_EQ(RandIndexDifference({1, 1, 1, 1}, {1, 1, 2, 2}), 0.5);
}

}  // namespace
}  // namespace marrow
