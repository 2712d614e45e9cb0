// Whole runs over posed creatures.
#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tests/testing/creature_mesh.h"
#include "tests/testing/invariants.h"
#include "tests/testing/run.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

SegmentationOptions TwoLevels() {
  SegmentationOptions options;
  options.method = Method::kPaper;
  options.eigen_pairs = 100;
  options.levels = 2;
  return options;
}

class CreatureTest : public ::testing::TestWithParam<std::string> {};

TEST_P(CreatureTest, ResultsAreSoundAndTheNumberingDoesNotMatter) {
  const TriangleMesh mesh = MakeCreature(GetParam()).mesh;
  const RecordingSink run = RunOn(mesh, TwoLevels());
  ASSERT_EQ(run.levels.size(), 2u);
  const Adjacency adjacency(run.mesh.mesh);
  ExpectSoundTree(run.mesh.mesh, adjacency, run.tree, run.mesh.report.area,
                  true);
  for (const auto& level : run.levels)
    ExpectSoundSkeleton(run.mesh.mesh, adjacency, run.tree, level.level,
                        level.skeleton);

  const Renumbering renumbering = Renumber(mesh, 9);
  const RecordingSink other = RunOn(renumbering.mesh, TwoLevels());
  ExpectSameTree(other.tree, run.tree);
  for (size_t i = 0; i < 2; ++i)
    for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
      ASSERT_EQ(other.levels[i].face_labels[f],
                run.levels[i].face_labels[renumbering.old_face[f]]);
}

// By the default method: it measures the surface, where the operator does not
// see which way faces are turned.
TEST_P(CreatureTest, WhichWayFacesAreTurnedDoesNotMatter) {
  const TriangleMesh mesh = MakeCreature(GetParam()).mesh;
  SegmentationOptions options;
  options.levels = 3;
  const RecordingSink expected = RunOn(mesh, options);
  TriangleMesh half = mesh, doubled = mesh;
  std::mt19937 random(7);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const auto [a, b, c] = mesh.faces[f];
    if (random() % 2 == 0) half.faces[f] = {a, c, b};
    doubled.faces.push_back({a, c, b});
  }
  for (const TriangleMesh& other : {half, doubled}) {
    const RecordingSink run = RunOn(other, options);
    ExpectSameTree(run.tree, expected.tree);
    ASSERT_EQ(run.levels.size(), expected.levels.size());
    for (size_t i = 0; i < run.levels.size(); ++i)
      for (uint32_t f = 0; f < other.NumFaces(); ++f)
        ASSERT_EQ(run.levels[i].face_labels[f],
                  expected.levels[i].face_labels[f % mesh.NumFaces()]);
  }
}

TEST_P(CreatureTest, RotationAndScaleKeepThePartition) {
  const TriangleMesh mesh = MakeCreature(GetParam()).mesh;
  SegmentationOptions merge;
  merge.levels = 3;
  for (const SegmentationOptions& options : {TwoLevels(), merge}) {
    const RecordingSink run = RunOn(mesh, options);
    for (const TriangleMesh& moved :
         {Scaled(Rotated(mesh, {2, -1, 1}, 0.7), 12.5), Scaled(mesh, 0.01),
          Rotated(mesh, {0, 0, 1}, std::numbers::pi)}) {
      const RecordingSink other = RunOn(moved, options);
      ASSERT_EQ(other.levels.size(), run.levels.size());
      for (size_t i = 0; i < run.levels.size(); ++i)
        EXPECT_LE(RandIndexDifference(other.levels[i].face_labels,
                                      run.levels[i].face_labels),
                  0.002)
            << "level " << i + 1;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, CreatureTest,
                         ::testing::Values("humanoid", "quadruped", "hand",
                                           "octopus"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace marrow
