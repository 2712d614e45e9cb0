// Creatures of shells that touch in vertices alone.
#include <gtest/gtest.h>

#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/mesh/components.h"
#include "tests/testing/invariants.h"
#include "tests/testing/run.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

TEST(TouchingShellsTest, ArmsThatShareVerticesAloneWithTheirTrunkAreThree) {
  const TriangleMesh mesh = TouchingGrids();
  DisjointSets sets(mesh.NumVertices());
  JoinCorners(mesh, sets);
  std::vector<uint32_t> shells;
  for (const Triangle& face : mesh.faces) shells.push_back(sets.Find(face[0]));
  for (Method method : {Method::kPaper, Method::kMerge}) {
    const RecordingSink run = RunOn(mesh, Levels(1, method));
    EXPECT_EQ(run.mesh.report.components, 1u);
    EXPECT_EQ(run.mesh.report.bridged_components, 3u);
    if (method == Method::kMerge)
      EXPECT_LE(RandIndexDifference(run.levels[0].face_labels, shells), 0.05);
    ExpectSoundTree(run.mesh.mesh, Adjacency(run.mesh.mesh), run.tree,
                    run.mesh.report.area, true, method == Method::kMerge);
    ExpectSoundSkeleton(run.mesh.mesh, Adjacency(run.mesh.mesh),
                        run.levels[0].tree, 1, run.levels[0].skeleton);
  }
}

// A chain of beads too light to be parts is of one component with the balls at
// its ends, and holds them together.
TEST(TouchingShellsTest, BeadsThatTouchStayWithWhatTheyHang) {
  std::vector<TriangleMesh> chain = {Icosphere(3)};
  const auto add = [&](double radius, double x) {
    chain.push_back(Icosphere(radius < 1 ? 1 : 3));
    chain.back().positions *= radius;
    chain.back().positions.col(0).array() += x;
  };
  const double first = chain[0].positions.col(0).maxCoeff();
  const double reach = Icosphere(1).positions.col(0).maxCoeff() * 0.0625;
  for (int i = 0; i < 40; ++i) add(0.0625, first + (2 * i + 1) * reach);
  add(1, first + 80 * reach + first);
  const RecordingSink run = RunOn(Together(chain), Levels(1, Method::kMerge));
  EXPECT_EQ(run.mesh.report.components, 1u);
  EXPECT_EQ(run.mesh.report.bodies, 1u);
  EXPECT_EQ(run.mesh.report.attached_components, 0u);
}

// The root is of all bodies, and its medial structure that of the largest.
TEST(TouchingShellsTest, BodiesOfTouchingShellsHaveASoundRoot) {
  TriangleMesh other = TouchingGrids();
  other.positions *= 1.1;
  other.positions.rowwise() += Eigen::RowVector3d(30, 0, 0);
  for (Method method : {Method::kPaper, Method::kMerge}) {
    const RecordingSink run =
        RunOn(Together({TouchingGrids(), other}), Levels(2, method));
    EXPECT_EQ(run.mesh.report.bodies, 2u);
    EXPECT_EQ(run.mesh.report.bridged_components, 6u);
    ExpectSoundTree(run.mesh.mesh, Adjacency(run.mesh.mesh), run.tree,
                    run.mesh.report.area, true, method == Method::kMerge);
  }
}

}  // namespace
}  // namespace marrow
