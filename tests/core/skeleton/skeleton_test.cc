#include "core/skeleton/skeleton.h"

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/hierarchy/tree_builder.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/invariants.h"
#include "tests/testing/shapes.h"
#include "tests/testing/solved_mesh.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

class SkeletonOfAnyShape : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(SkeletonOfAnyShape, KeepsItsPromises) {
  const SolvedMesh solved = SolveMesh(GetParam().mesh, 60);
  const CancelToken cancel;
  TreeBuilder builder(solved.context(), SplitOptions{.kappa = 0.6},
                      solved.canonical.report.area);
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(builder.Deepen(cancel, nullptr).ok());
  for (uint32_t level = 0; level <= builder.depth(); ++level) {
    SCOPED_TRACE(level);
    const Skeleton skeleton = BuildSkeleton(
        solved.canonical.mesh, solved.adjacency, builder.tree(), level);
    ExpectSoundSkeleton(solved.canonical.mesh, solved.adjacency, builder.tree(),
                        level, skeleton);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, SkeletonOfAnyShape,
                         ::testing::ValuesIn(AllShapes()),
                         [](const auto& info) {
                           return TestNameOf(info.param);
                         });

// A tree of one level that `label` gives face by face; segment s is node s + 1.
SegmentTree TreeOf(const TriangleMesh& mesh, uint32_t segments,
                   const std::function<uint32_t(Eigen::Vector3d)>& label,
                   std::vector<uint32_t> root_structure) {
  SegmentTree tree;
  tree.nodes.resize(segments + 1);
  tree.nodes[0].medial_structure = std::move(root_structure);
  for (uint32_t s = 1; s <= segments; ++s) {
    tree.nodes[s].id = s;
    tree.nodes[s].parent = 0;
    tree.nodes[s].level = 1;
    tree.nodes[0].children.push_back(s);
  }
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (uint32_t v : mesh.faces[f]) centre += mesh.Position(v) / 3;
    tree.nodes[0].faces.push_back(f);
    tree.nodes[label(centre) + 1].faces.push_back(f);
  }
  // Equal triangles, so plain means are the centroids.
  for (SegmentNode& node : tree.nodes) {
    for (uint32_t f : node.faces)
      for (uint32_t v : mesh.faces[f])
        node.centroid += mesh.Position(v) / 3 / node.faces.size();
  }
  return tree;
}

TEST(SkeletonTest, AChainOfThreeRootedAtItsMiddle) {
  const TriangleMesh mesh = Grid(9, 2);
  // Thirds along x. The vertices of column 4 are 12 to 14.
  const SegmentTree tree = TreeOf(
      mesh, 3, [](const auto& p) { return static_cast<uint32_t>(p.x() / 3); },
      {12, 13, 14});
  const Skeleton skeleton = BuildSkeleton(mesh, Adjacency(mesh), tree, 1);
  ASSERT_EQ(skeleton.joints.size(), 5u);
  EXPECT_THAT(skeleton.joints[0].segments, ElementsAre(2));
  EXPECT_NEAR(skeleton.joints[0].position.x(), 4.5, 1e-12);
  std::map<uint32_t, double> articulations;  // outer segment -> x
  for (const Joint& joint : skeleton.joints) {
    EXPECT_NEAR(joint.position.y(), 1, 1e-12);
    if (!joint.articulation) continue;
    EXPECT_EQ(joint.parent, 0u);
    EXPECT_EQ(joint.segments[0], 2u);
    articulations[joint.segments[1]] = joint.position.x();
  }
  EXPECT_NEAR(articulations.at(1), 3, 1e-12);
  EXPECT_NEAR(articulations.at(3), 6, 1e-12);
}

// The left two columns, and the rest cut in two at y = 1.
SegmentTree ThreeInACycle(const TriangleMesh& mesh) {
  return TreeOf(mesh, 3,
                [](const auto& p) {
                  if (p.x() < 2) return 0u;
                  return p.y() < 1 ? 1u : 2u;
                },
                {0});
}

TEST(SkeletonTest, InACycleEverySegmentHangsOnItsShortestWayToTheRoot) {
  // Boundaries of 1, 3 and 4 units: all may carry a bone.
  const TriangleMesh mesh = Grid(6, 4);
  const Skeleton skeleton =
      BuildSkeleton(mesh, Adjacency(mesh), ThreeInACycle(mesh), 1);
  ASSERT_EQ(skeleton.joints.size(), 5u);
  EXPECT_THAT(skeleton.joints[0].segments, ElementsAre(1));
  EXPECT_THAT(skeleton.joints[1].segments, ElementsAre(1, 3));
  EXPECT_THAT(skeleton.joints[3].segments, ElementsAre(1, 2));
  for (uint32_t j : {1u, 3u}) EXPECT_EQ(skeleton.joints[j].parent, 0u);
  EXPECT_NEAR((skeleton.joints[3].position - Eigen::Vector3d(2, 0.5, 0)).norm(),
              0, 1e-12);
}

// A strip of the boundary that a third segment takes moves its centre, but does
// not leave half of it.
TEST(SkeletonTest, AJointIsInTheMiddleOfItsWholeOpening) {
  const TriangleMesh mesh = Grid(8, 9);
  // A square in the middle of the left half's border.
  const SegmentTree tree =
      TreeOf(mesh, 3,
             [](const auto& p) {
               if (std::abs(p.x() - 4) < 1 && p.y() > 3 && p.y() < 5) return 2u;
               return p.x() < 4 ? 0u : 1u;
             },
             {0});
  const Skeleton skeleton = BuildSkeleton(mesh, Adjacency(mesh), tree, 1);
  bool found = false;
  for (const Joint& joint : skeleton.joints) {
    if (!joint.articulation || joint.segments != std::vector<uint32_t>{1, 2})
      continue;
    found = true;
    // Of y from 0 to 3 and from 5 to 9.
    EXPECT_NEAR(joint.position.x(), 4, 1e-12);
    EXPECT_NEAR(joint.position.y(), (3 * 1.5 + 4 * 7) / 7, 1e-12);
  }
  EXPECT_TRUE(found);
}

TEST(SkeletonTest, NoBoneRunsThroughAMereContact) {
  // Boundaries of 1, 7 and 6 units: the first is less than a quarter of both.
  const TriangleMesh mesh = Grid(8, 8);
  const Skeleton skeleton =
      BuildSkeleton(mesh, Adjacency(mesh), ThreeInACycle(mesh), 1);
  ASSERT_EQ(skeleton.joints.size(), 5u);
  EXPECT_THAT(skeleton.joints[0].segments, ElementsAre(1));
  EXPECT_THAT(skeleton.joints[1].segments, ElementsAre(1, 3));
  EXPECT_THAT(skeleton.joints[2].segments, ElementsAre(3));
  EXPECT_THAT(skeleton.joints[3].segments, ElementsAre(3, 2));
  EXPECT_NEAR((skeleton.joints[3].position - Eigen::Vector3d(5, 1, 0)).norm(),
              0, 1e-12);
}

TEST(SkeletonTest, SeparateBodiesHangOnTheNearestCentre) {
  const TriangleMesh mesh = Apart(Apart(Grid(2, 2), Grid(2, 2)), Grid(2, 2));
  // Bodies begin at 0, 3 and 6; the last is the root's.
  const SegmentTree tree = TreeOf(
      mesh, 3, [](const auto& p) { return static_cast<uint32_t>(p.x() / 3); },
      {18, 19});
  const Skeleton skeleton = BuildSkeleton(mesh, Adjacency(mesh), tree, 1);
  ASSERT_EQ(skeleton.joints.size(), 3u);
  EXPECT_THAT(skeleton.joints[0].segments, ElementsAre(3));
  EXPECT_THAT(skeleton.joints[1].segments, ElementsAre(2));
  EXPECT_THAT(skeleton.joints[2].segments, ElementsAre(1));
  EXPECT_EQ(skeleton.joints[1].parent, 0u);
  EXPECT_EQ(skeleton.joints[2].parent, 1u);
  for (const Joint& joint : skeleton.joints) EXPECT_FALSE(joint.articulation);
}

TEST(SkeletonTest, ManyBodiesStayQuick) {
  constexpr uint32_t kBodies = 3000;
  TriangleMesh mesh;
  mesh.positions.resize(3 * kBodies, 3);
  for (uint32_t b = 0; b < kBodies; ++b) {
    mesh.positions.row(3 * b) << 2 * b, 0, 0;
    mesh.positions.row(3 * b + 1) << 2 * b + 1, 0, 0;
    mesh.positions.row(3 * b + 2) << 2 * b, 1, 0;
    mesh.faces.push_back({3 * b, 3 * b + 1, 3 * b + 2});
  }
  const SegmentTree tree = TreeOf(
      mesh, kBodies,
      [](const auto& p) { return static_cast<uint32_t>(p.x() / 2); }, {0});
  const Skeleton skeleton = BuildSkeleton(mesh, Adjacency(mesh), tree, 1);
  ASSERT_EQ(skeleton.joints.size(), kBodies);
  for (uint32_t j = 1; j < kBodies; ++j)
    EXPECT_EQ(skeleton.joints[j].parent, j - 1);
}

}  // namespace
}  // namespace marrow
