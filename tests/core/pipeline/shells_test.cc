// Creatures that come in several pieces: shells, specks, straps, and two in one
// file.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "tests/testing/creature_mesh.h"
#include "tests/testing/invariants.h"
#include "tests/testing/run.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

double Diagonal(const TriangleMesh& mesh) {
  return (mesh.positions.colwise().maxCoeff() -
          mesh.positions.colwise().minCoeff())
      .norm();
}

// Adds a vertex and returns its number.
uint32_t AddVertex(TriangleMesh& mesh, const Eigen::RowVector3d& place) {
  mesh.positions.conservativeResize(mesh.positions.rows() + 1, 3);
  mesh.positions.bottomRows(1) = place;
  return mesh.NumVertices() - 1;
}

// A shell a part: the rims of two neighbours stand `gap` apart, each drawn back
// along its own skin by half of that.
TriangleMesh CutAtJoints(const CreatureMesh& creature, double gap) {
  const TriangleMesh& whole = creature.mesh;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> own;  // part, old -> new
  std::vector<std::set<uint32_t>> parts(whole.NumVertices());
  for (uint32_t f = 0; f < whole.NumFaces(); ++f)
    for (uint32_t v : whole.faces[f]) {
      own.emplace(std::pair(creature.parts[f], v), 0);
      parts[v].insert(creature.parts[f]);
    }
  TriangleMesh cut;
  cut.positions.resize(own.size(), 3);
  Positions inward = Positions::Zero(own.size(), 3);
  uint32_t next = 0;
  for (auto& [key, id] : own) {
    cut.positions.row(next) = whole.positions.row(key.second);
    id = next++;
  }
  for (uint32_t f = 0; f < whole.NumFaces(); ++f) {
    Triangle face;
    for (int i = 0; i < 3; ++i)
      face[i] = own.at({creature.parts[f], whole.faces[f][i]});
    cut.faces.push_back(face);
    const Eigen::RowVector3d centre =
        (cut.positions.row(face[0]) + cut.positions.row(face[1]) +
         cut.positions.row(face[2])) /
        3;
    for (uint32_t v : face) inward.row(v) += centre - cut.positions.row(v);
  }
  for (const auto& [key, id] : own)
    if (parts[key.second].size() > 1)
      cut.positions.row(id) += gap / 2 * inward.row(id).normalized();
  return cut;
}

// Closes every hole with a fan; the old faces keep their numbers.
TriangleMesh Capped(TriangleMesh mesh) {
  const Adjacency adjacency(mesh);
  DisjointSets loops(mesh.NumVertices());
  std::vector<std::array<uint32_t, 2>> rim;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    if (adjacency.IsBoundaryEdge(e)) {
      rim.push_back(adjacency.EdgeVertices(e));
      loops.Union(rim.back()[0], rim.back()[1]);
    }
  std::map<uint32_t, std::pair<Eigen::RowVector3d, double>> sums;
  for (const auto& edge : rim)
    for (uint32_t v : edge) {
      auto& [sum, count] =
          sums.try_emplace(loops.Find(v), Eigen::RowVector3d::Zero(), 0)
              .first->second;
      sum += mesh.positions.row(v);
      ++count;
    }
  std::map<uint32_t, uint32_t> apex;
  for (const auto& [loop, sum] : sums)
    apex[loop] = AddVertex(mesh, sum.first / sum.second);
  for (const auto& [u, v] : rim)
    mesh.faces.push_back({u, v, apex.at(loops.Find(u))});
  return mesh;
}

std::vector<uint32_t> FirstOf(std::vector<uint32_t> labels, size_t count) {
  labels.resize(count);
  return labels;
}

class ShellsTest : public ::testing::TestWithParam<std::string> {};

// Caps are walls inside the limbs that the whole body has not.
TEST_P(ShellsTest, CutAtTheJointsAreOneBody) {
  const CreatureMesh creature = MakeCreature(GetParam());
  const TriangleMesh open =
      CutAtJoints(creature, 0.005 * Diagonal(creature.mesh));
  for (Method method : {Method::kPaper, Method::kMerge}) {
    const RecordingSink whole = RunOn(creature.mesh, Levels(1, method));
    const std::vector<std::pair<TriangleMesh, double>> cuts = {
        {open, 0.08}, {Capped(open), 0.12}};
    for (const auto& [cut, tolerance] : cuts) {
      SCOPED_TRACE(testing::Message() << "method " << static_cast<int>(method)
                                      << " within " << tolerance);
      const RecordingSink run = RunOn(cut, Levels(1, method));
      EXPECT_GT(run.mesh.report.components, 4u);
      EXPECT_EQ(run.mesh.report.bodies, 1u);
      EXPECT_EQ(run.mesh.report.bridged_components, run.mesh.report.components);
      EXPECT_LE(RandIndexDifference(FirstOf(run.levels[0].face_labels,
                                            creature.mesh.NumFaces()),
                                    whole.levels[0].face_labels),
                tolerance);
    }
  }
}

TEST_P(ShellsTest, SkeletonsConnectAcrossThem) {
  const CreatureMesh creature = MakeCreature(GetParam());
  const RecordingSink run =
      RunOn(CutAtJoints(creature, 0.005 * Diagonal(creature.mesh)), Levels(1));
  const RecordingSink::Level& level = run.levels[0];
  // Every bone has an articulation at its gap, or inside of a shell.
  EXPECT_EQ(level.skeleton.joints.size(),
            2 * level.tree.SegmentsAtLevel(1).size() - 1);
  ExpectSoundSkeleton(run.mesh.mesh, Adjacency(run.mesh.mesh), level.tree, 1,
                      level.skeleton);
}

// Tiny tetrahedra strewn around a creature, near and far.
TriangleMesh WithSpecks(TriangleMesh mesh, uint32_t count) {
  std::mt19937 random(7);
  const Eigen::RowVector3d low = mesh.positions.colwise().minCoeff();
  const Eigen::RowVector3d size =
      mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff();
  const TriangleMesh speck = Tetrahedron();
  uint32_t next = mesh.NumVertices();
  mesh.positions.conservativeResize(next + 4 * count, 3);
  for (uint32_t s = 0; s < count; ++s) {
    Eigen::RowVector3d place;
    for (int i = 0; i < 3; ++i)
      place[i] = low[i] + size[i] * (3 * (random() * 0x1p-32) - 1);
    for (const Triangle& face : speck.faces)
      mesh.faces.push_back({face[0] + next, face[1] + next, face[2] + next});
    for (uint32_t v = 0; v < 4; ++v)
      mesh.positions.row(next++) =
          place + 1e-3 * size.norm() * speck.positions.row(v);
  }
  return mesh;
}

TEST_P(ShellsTest, AThousandSpecksChangeNothing) {
  const TriangleMesh mesh = MakeCreature(GetParam()).mesh;
  const RecordingSink clean = RunOn(mesh, Levels(2));
  const RecordingSink run = RunOn(WithSpecks(mesh, 1000), Levels(2));
  EXPECT_EQ(run.mesh.report.components, 1001u);
  EXPECT_EQ(run.mesh.report.attached_components, 1000u);
  EXPECT_EQ(run.mesh.report.attached_faces, 4000u);
  ASSERT_EQ(run.levels.size(), clean.levels.size());
  for (size_t i = 0; i < run.levels.size(); ++i) {
    const auto& labels = run.levels[i].face_labels;
    EXPECT_EQ(FirstOf(labels, mesh.NumFaces()), clean.levels[i].face_labels);
    // Nor do they pull joints out of the body.
    const auto& joints = run.levels[i].skeleton.joints;
    ASSERT_EQ(joints.size(), clean.levels[i].skeleton.joints.size());
    for (size_t j = 0; j < joints.size(); ++j)
      EXPECT_LE(
          (joints[j].position - clean.levels[i].skeleton.joints[j].position)
              .norm(),
          1e-9 * Diagonal(mesh));
    // A speck is in one piece at every level.
    for (size_t f = mesh.NumFaces(); f < labels.size(); f += 4)
      for (size_t i = 1; i < 4; ++i) EXPECT_EQ(labels[f + i], labels[f]);
  }
  ExpectSoundTree(run.mesh.mesh, Adjacency(run.mesh.mesh), run.tree,
                  run.mesh.report.area, true);
}

INSTANTIATE_TEST_SUITE_P(Samples, ShellsTest,
                         ::testing::Values("humanoid", "quadruped", "hand",
                                           "octopus"),
                         [](const auto& info) { return info.param; });

TriangleMesh Moved(TriangleMesh mesh, const Eigen::RowVector3d& by) {
  mesh.positions.rowwise() += by;
  return mesh;
}

TEST(BodiesTest, TwoCreaturesAreChildrenOfTheRoot) {
  const TriangleMesh octopus = MakeCreature("octopus").mesh;
  const TriangleMesh hand = Scaled(MakeCreature("hand").mesh, 0.7);
  const TriangleMesh mesh =
      Together({octopus, Moved(hand, {3 * Diagonal(octopus), 0, 0})});
  const RecordingSink run = RunOn(mesh, Levels(2));
  EXPECT_EQ(run.mesh.report.bodies, 2u);
  ASSERT_EQ(run.levels.size(), 2u);
  const auto& first = run.levels[0].face_labels;
  EXPECT_EQ(std::set<uint32_t>(first.begin(), first.end()).size(), 2u);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    EXPECT_EQ(first[f],
              first[f < octopus.NumFaces() ? 0 : mesh.NumFaces() - 1]);
  ExpectSoundTree(run.mesh.mesh, Adjacency(run.mesh.mesh), run.tree,
                  run.mesh.report.area, true);

  // Each at its own scale, as if it were alone.
  const RecordingSink alone = RunOn(octopus, Levels(1));
  EXPECT_LE(RandIndexDifference(
                FirstOf(run.levels[1].face_labels, octopus.NumFaces()),
                alone.levels[0].face_labels),
            0.01);
}

// A level of merged pieces is the same cut of every body.
TEST(BodiesTest, MergedCreaturesKeepTheirLevels) {
  const TriangleMesh octopus = MakeCreature("octopus").mesh;
  const TriangleMesh hand = Scaled(MakeCreature("hand").mesh, 0.7);
  const TriangleMesh mesh =
      Together({octopus, Moved(hand, {3 * Diagonal(octopus), 0, 0})});
  const RecordingSink run = RunOn(mesh, Levels(3, Method::kMerge));
  ExpectSoundTree(run.mesh.mesh, Adjacency(run.mesh.mesh), run.tree,
                  run.mesh.report.area, true, true);
  EXPECT_EQ(run.tree.nodes[0].salience, 1);
  const RecordingSink alone = RunOn(octopus, Levels(3, Method::kMerge));
  for (size_t i = 0; i < run.levels.size(); ++i) {
    const auto& labels = run.levels[i].face_labels;
    EXPECT_LE(
        RandIndexDifference(
            FirstOf(labels, octopus.NumFaces()),
            alone.levels[std::min(i, alone.levels.size() - 1)].face_labels),
        0.01);
    const std::set<uint32_t> first(labels.begin(),
                                   labels.begin() + octopus.NumFaces());
    for (size_t f = octopus.NumFaces(); f < labels.size(); ++f)
      ASSERT_FALSE(first.contains(labels[f]));
  }
}

// Bridged shells merge like pieces of one skin.
TEST_P(ShellsTest, MergeAcrossTheGaps) {
  const CreatureMesh creature = MakeCreature(GetParam());
  const RecordingSink run =
      RunOn(CutAtJoints(creature, 0.005 * Diagonal(creature.mesh)),
            Levels(3, Method::kMerge));
  EXPECT_EQ(run.mesh.report.bodies, 1u);
  EXPECT_LT(run.levels[0].tree.SegmentsAtLevel(1).size(),
            run.mesh.report.components + 2u);
  ExpectSoundTree(run.mesh.mesh, Adjacency(run.mesh.mesh), run.tree,
                  run.mesh.report.area, true, true);
}

// Twelve faces, from one corner to the other.
TriangleMesh Box(const Eigen::RowVector3d& low,
                 const Eigen::RowVector3d& high) {
  TriangleMesh box;
  box.positions.resize(8, 3);
  for (int v = 0; v < 8; ++v)
    for (int i = 0; i < 3; ++i)
      box.positions(v, i) = v >> i & 1 ? high[i] : low[i];
  for (const auto& [a, b, c, d] :
       std::initializer_list<std::array<uint32_t, 4>>{{0, 1, 3, 2},
                                                      {4, 6, 7, 5},
                                                      {0, 4, 5, 1},
                                                      {2, 3, 7, 6},
                                                      {0, 2, 6, 4},
                                                      {1, 5, 7, 3}}) {
    box.faces.push_back({a, b, c});
    box.faces.push_back({a, c, d});
  }
  return box;
}

// Where no vertex of a leg is near to one of the trunk.
TEST(BodiesTest, LegsOfBoxesStandInTheirTrunk) {
  TriangleMesh dog = Box({0, 0, 0}, {10, 3, 3});
  for (double x : {1.0, 8.0})
    for (double z : {0.3, 1.9})
      dog = Together({dog, Box({x, -4, z}, {x + 0.8, 0.5, z + 0.8})});
  const RecordingSink run = RunOn(dog, Levels(1, Method::kMerge));
  EXPECT_EQ(run.mesh.report.bodies, 1u);
  EXPECT_EQ(run.mesh.report.bridged_components, 5u);
  ASSERT_EQ(run.levels[0].tree.SegmentsAtLevel(1).size(), 5u);
  const auto& labels = run.levels[0].face_labels;
  for (uint32_t f = 0; f < labels.size(); ++f)
    EXPECT_EQ(labels[f], labels[f - f % 12]) << f;
  // Every leg hangs on the trunk.
  std::map<uint32_t, std::set<uint32_t>> beside;
  for (const Joint& joint : run.levels[0].skeleton.joints)
    if (joint.articulation)
      for (uint32_t a : joint.segments)
        for (uint32_t b : joint.segments)
          if (a != b) beside[a].insert(b);
  EXPECT_EQ(beside[labels[0]].size(), 4u);
}

// Longer than all of the body, and slower than any of its limbs.
TEST(BodiesTest, AStaffInAHandChangesNoLimb) {
  const TriangleMesh body = MakeCreature("humanoid").mesh;
  const SegmentationOptions options = Levels(2, Method::kMerge);
  const RecordingSink alone = RunOn(body, options);
  Eigen::Index hand;
  body.positions.col(0).maxCoeff(&hand);
  const Eigen::Vector3d at = body.positions.row(hand);
  for (double above : {1.5, 2.0}) {
    const TriangleMesh staff = Box(at - Eigen::Vector3d(0.02, 0.3, 0.02),
                                   at + Eigen::Vector3d(0.02, above, 0.02));
    const RecordingSink run = RunOn(Together({body, staff}), options);
    EXPECT_EQ(run.mesh.report.bodies, 1u);
    for (const auto& [with, without] :
         {std::pair(run.levels.front(), alone.levels.front()),
          std::pair(run.levels.back(), alone.levels.back())})
      EXPECT_LE(RandIndexDifference(FirstOf(with.face_labels, body.NumFaces()),
                                    without.face_labels),
                0.03)
          << above;
  }
}

// More of the area than the body, and no more than its hair. No two strands
// lie along one line, where they would be sewn.
TEST(BodiesTest, HairFollowsTheBody) {
  const TriangleMesh body = MakeCreature("humanoid").mesh;
  const RecordingSink clean = RunOn(body, Levels(2, Method::kMerge));
  const double step = 0.05 * Diagonal(body);
  TriangleMesh mesh = body;
  constexpr uint32_t kStrands = 1500;
  mesh.positions.conservativeResize(body.NumVertices() + 8 * kStrands, 3);
  uint32_t next = body.NumVertices();
  for (uint32_t s = 0; s < kStrands; ++s) {
    const Eigen::RowVector3d root = body.positions.row(s % body.NumVertices());
    for (uint32_t i = 0; i < 8; ++i)
      mesh.positions.row(next + i) =
          root + step * Eigen::RowVector3d(
                            (0.1 + i % 2 * 0.1) * std::cos(s), 0.1 + i / 2,
                            0.2 + (0.1 + i % 2 * 0.1) * std::sin(s));
    for (uint32_t i = 0; i < 6; ++i)
      mesh.faces.push_back({next + i, next + i + 1, next + i + 2});
    next += 8;
  }
  const RecordingSink run = RunOn(mesh, Levels(2, Method::kMerge));
  EXPECT_EQ(run.mesh.report.attached_components, kStrands);
  for (size_t i = 0; i < run.levels.size(); ++i)
    EXPECT_EQ(FirstOf(run.levels[i].face_labels, body.NumFaces()),
              clean.levels[i].face_labels);
}

TEST(BodiesTest, AnEyeFollowsTheHead) {
  const CreatureMesh creature = MakeCreature("humanoid");
  const RecordingSink clean = RunOn(creature.mesh, Levels(3));
  // Above the head, farther than shells are bridged.
  Eigen::Index top;
  creature.mesh.positions.col(1).maxCoeff(&top);
  const double diagonal = Diagonal(creature.mesh);
  const TriangleMesh mesh = Together(
      {creature.mesh, Moved(Scaled(Icosphere(2), 0.01 * diagonal),
                            creature.mesh.positions.row(top) +
                                Eigen::RowVector3d(0, 0.06 * diagonal, 0))});
  const RecordingSink run = RunOn(mesh, Levels(3));
  EXPECT_EQ(run.mesh.report.attached_components, 1u);
  const Adjacency adjacency(creature.mesh);
  const uint32_t head =
      adjacency.VertexFaces(static_cast<uint32_t>(top)).front();
  ASSERT_EQ(run.levels.size(), clean.levels.size());
  for (size_t i = 0; i < run.levels.size(); ++i) {
    const auto& labels = run.levels[i].face_labels;
    EXPECT_EQ(FirstOf(labels, creature.mesh.NumFaces()),
              clean.levels[i].face_labels);
    for (size_t f = creature.mesh.NumFaces(); f < labels.size(); ++f)
      EXPECT_EQ(labels[f], labels[head]);
  }
}

TEST(BodiesTest, FlippedFacesChangeNothing) {
  const TriangleMesh mesh = MakeCreature("quadruped").mesh;
  TriangleMesh flipped = mesh;
  std::mt19937 random(3);
  for (Triangle& face : flipped.faces)
    if (random() % 2) std::swap(face[1], face[2]);
  const RecordingSink expected = RunOn(mesh, Levels(2));
  const RecordingSink run = RunOn(flipped, Levels(2));
  ASSERT_EQ(run.levels.size(), expected.levels.size());
  for (size_t i = 0; i < run.levels.size(); ++i)
    EXPECT_LE(RandIndexDifference(run.levels[i].face_labels,
                                  expected.levels[i].face_labels),
              0.001);
}

// How far the first level of the mesh without some faces is from that with
// them.
double DifferenceWithout(const TriangleMesh& mesh,
                         const std::vector<bool>& missing, Method method) {
  TriangleMesh holed = mesh;
  holed.faces.clear();
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (!missing[f]) holed.faces.push_back(mesh.faces[f]);
  const RecordingSink expected = RunOn(mesh, Levels(1, method));
  const RecordingSink run = RunOn(holed, Levels(1, method));
  EXPECT_GE(run.mesh.report.boundary_loops, 30u);
  std::vector<uint32_t> labels;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (!missing[f]) labels.push_back(expected.levels[0].face_labels[f]);
  return RandIndexDifference(run.levels[0].face_labels, labels);
}

// Without every 60th vertex and the faces around it.
TEST_P(ShellsTest, HolesAreNoJoints) {
  const TriangleMesh mesh = MakeCreature(GetParam()).mesh;
  std::vector<bool> missing;
  for (const Triangle& t : mesh.faces)
    missing.push_back(std::any_of(t.begin(), t.end(),
                                  [](uint32_t v) { return v % 60 == 0; }));
  EXPECT_LE(DifferenceWithout(mesh, missing, Method::kPaper), 0.03);
  EXPECT_LE(DifferenceWithout(mesh, missing, Method::kMerge), 0.04);
}

// Without one face in a hundred.
TEST_P(ShellsTest, MissingFacesAreNoJoints) {
  const TriangleMesh mesh = MakeCreature(GetParam()).mesh;
  constexpr int kTimes = 4;
  double paper = 0, merge = 0;
  for (int time = 0; time < kTimes; ++time) {
    std::mt19937 random(time);
    std::vector<bool> missing;
    for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
      missing.push_back(random() % 100 == 0);
    paper += DifferenceWithout(mesh, missing, Method::kPaper) / kTimes;
    merge += DifferenceWithout(mesh, missing, Method::kMerge) / kTimes;
  }
  EXPECT_LE(paper, 0.01);
  EXPECT_LE(merge, 0.04);
}

// Without three faces in ten, which leaves more rims than anything else.
TEST_P(ShellsTest, ASieveIsSegmentedAsTheSurface) {
  const TriangleMesh mesh = MakeCreature(GetParam()).mesh;
  std::mt19937 random(8);
  std::vector<bool> missing;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    missing.push_back(random() % 10 < 3);
  EXPECT_LE(DifferenceWithout(mesh, missing, Method::kPaper), 0.05);
  EXPECT_LE(DifferenceWithout(mesh, missing, Method::kMerge), 0.1);
}

// Every triangle by itself, at .7 of its size.
TEST_P(ShellsTest, ShredsAreSegmentedAsTheSurface) {
  const TriangleMesh mesh = MakeCreature(GetParam()).mesh;
  TriangleMesh shreds;
  shreds.positions.resize(3 * mesh.NumFaces(), 3);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (uint32_t v : mesh.faces[f]) centre += mesh.Position(v) / 3;
    for (uint32_t i = 0; i < 3; ++i)
      shreds.positions.row(3 * f + i) =
          (centre + 0.7 * (mesh.Position(mesh.faces[f][i]) - centre))
              .transpose();
    shreds.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  for (Method method : {Method::kPaper, Method::kMerge}) {
    const RecordingSink expected = RunOn(mesh, Levels(1, method));
    const RecordingSink run = RunOn(shreds, Levels(1, method));
    EXPECT_EQ(run.mesh.report.bodies, 1u);
    EXPECT_LE(RandIndexDifference(run.levels[0].face_labels,
                                  expected.levels[0].face_labels),
              0.08);
  }
}

}  // namespace
}  // namespace marrow
