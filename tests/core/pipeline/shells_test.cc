// Creatures that come in several pieces: shells, specks, straps, and two in one
// file.
#include <gtest/gtest.h>

#include <algorithm>
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

SegmentationOptions Levels(uint32_t levels) {
  SegmentationOptions options;
  options.eigen_pairs = 100;
  options.levels = levels;
  return options;
}

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
    const Eigen::RowVector3d centre = (cut.positions.row(face[0]) +
                                       cut.positions.row(face[1]) +
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

TEST_P(ShellsTest, ShellsCutAtTheJointsAreOneBody) {
  const CreatureMesh creature = MakeCreature(GetParam());
  const RecordingSink whole = RunOn(creature.mesh, Levels(1));
  const TriangleMesh open =
      CutAtJoints(creature, 0.005 * Diagonal(creature.mesh));
  for (const TriangleMesh& cut : {open, Capped(open)}) {
    const RecordingSink run = RunOn(cut, Levels(1));
    EXPECT_GT(run.mesh.report.components, 4u);
    EXPECT_EQ(run.mesh.report.bodies, 1u);
    EXPECT_EQ(run.mesh.report.bridged_components,
              run.mesh.report.components -
                  run.mesh.report.attached_components);
    EXPECT_LE(RandIndexDifference(FirstOf(run.levels[0].face_labels,
                                          creature.mesh.NumFaces()),
                                  whole.levels[0].face_labels),
              0.08);
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, ShellsTest,
                         ::testing::Values("humanoid", "quadruped", "hand",
                                           "octopus"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace marrow
