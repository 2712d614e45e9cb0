#include "client/samples/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace marrow {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Pointwise;

using Triangle = std::array<uint32_t, 3>;
using Edge = std::pair<uint32_t, uint32_t>;

Triangle TriangleOf(const PolygonMesh& mesh, size_t f) {
  const auto face = mesh.Face(f);
  return {face[0], face[1], face[2]};
}

Eigen::Vector3d PointOf(const PolygonMesh& mesh, uint32_t v) {
  const auto& p = mesh.positions[v];
  return {p[0], p[1], p[2]};
}

Eigen::Vector3d AreaVectorOf(const PolygonMesh& mesh, size_t f) {
  const Triangle t = TriangleOf(mesh, f);
  const Eigen::Vector3d a = PointOf(mesh, t[0]);
  return 0.5 * (PointOf(mesh, t[1]) - a).cross(PointOf(mesh, t[2]) - a);
}

// The face on the left of every directed edge. Fails where two faces claim
// the same side, as faces of unlike orientation do.
std::map<Edge, size_t> LeftFaces(const PolygonMesh& mesh) {
  std::map<Edge, size_t> left;
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    const Triangle t = TriangleOf(mesh, f);
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(left.insert({{t[i], t[(i + 1) % 3]}, f}).second)
          << "face " << f;
    }
  }
  return left;
}

// The number of pieces of each label when faces join through edges.
std::map<uint32_t, int> PiecesOf(const PolygonMesh& mesh,
                                 const std::vector<uint32_t>& labels) {
  std::vector<size_t> parent(mesh.NumFaces());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](size_t f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  const auto left = LeftFaces(mesh);
  for (const auto& [edge, f] : left) {
    const auto twin = left.find({edge.second, edge.first});
    if (twin == left.end() || labels[twin->second] != labels[f]) continue;
    parent[root(f)] = root(twin->second);
  }
  std::map<uint32_t, int> pieces;
  for (size_t f = 0; f < parent.size(); ++f) {
    if (root(f) == f) ++pieces[labels[f]];
  }
  return pieces;
}

// Whether the vertex's faces form one ring.
bool EveryVertexIsOneFan(const PolygonMesh& mesh) {
  std::vector<std::map<uint32_t, uint32_t>> next(mesh.NumVertices());
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    const Triangle t = TriangleOf(mesh, f);
    for (int i = 0; i < 3; ++i) {
      next[t[i]][t[(i + 1) % 3]] = t[(i + 2) % 3];
    }
  }
  return std::all_of(next.begin(), next.end(), [](const auto& ring) {
    if (ring.empty()) return false;
    const uint32_t start = ring.begin()->first;
    uint32_t at = start;
    for (size_t steps = 1; steps <= ring.size(); ++steps) {
      const auto it = ring.find(at);
      if (it == ring.end()) return false;
      at = it->second;
      if (at == start) return steps == ring.size();
    }
    return false;
  });
}

double LeastAngle(const PolygonMesh& mesh, size_t f) {
  const Triangle t = TriangleOf(mesh, f);
  double least = M_PI;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d apex = PointOf(mesh, t[i]);
    const Eigen::Vector3d x = PointOf(mesh, t[(i + 1) % 3]) - apex;
    const Eigen::Vector3d y = PointOf(mesh, t[(i + 2) % 3]) - apex;
    least = std::min(least, std::atan2(x.cross(y).norm(), x.dot(y)));
  }
  return least * 180 / M_PI;
}

std::vector<double> AreaOfParts(const Sample& sample) {
  std::vector<double> areas(sample.part_names.size(), 0);
  for (size_t f = 0; f < sample.mesh.NumFaces(); ++f) {
    areas[sample.face_parts[f]] += AreaVectorOf(sample.mesh, f).norm();
  }
  const double whole = std::accumulate(areas.begin(), areas.end(), 0.);
  for (double& area : areas) area /= whole;
  return areas;
}

class EverySample : public ::testing::TestWithParam<std::string> {
 protected:
  // Made once for all tests: most of their time would go into making them.
  static const Sample& Make(const std::string& pose, uint32_t faces) {
    static auto& made =
        *new std::map<std::tuple<std::string, std::string, uint32_t>, Sample>;
    const auto key = std::make_tuple(GetParam(), pose, faces);
    if (!made.contains(key)) made[key] = MakeNew(pose, faces);
    return made[key];
  }
  static Sample MakeNew(const std::string& pose, uint32_t faces) {
    absl::StatusOr<Sample> sample = MakeSample(GetParam(), pose, faces);
    EXPECT_TRUE(sample.ok()) << sample.status();
    return sample.ok() ? *std::move(sample) : Sample{};
  }
  static std::vector<std::string> Poses() {
    for (const SampleInfo& info : ListSamples()) {
      if (info.name == GetParam()) return info.poses;
    }
    return {};
  }
};

std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const SampleInfo& info : ListSamples()) names.push_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Samples, EverySample, ::testing::ValuesIn(Names()),
                         [](const auto& info) { return info.param; });

TEST_P(EverySample, HasTheFacesAskedFor) {
  for (const uint32_t faces : {5000u, 7778u, 50000u}) {
    const Sample& sample = Make("", faces);
    EXPECT_EQ(sample.mesh.NumFaces(), faces);
    EXPECT_EQ(sample.face_parts.size(), faces);
    EXPECT_EQ(sample.mesh.face_vertices.size(), 3 * faces);
  }
  EXPECT_EQ(Make("", 5001).mesh.NumFaces(), 5000u);
}

TEST_P(EverySample, IsOneClosedManifoldOfGenusZero) {
  for (const uint32_t faces : {5000u, 10000u, 50000u}) {
    const PolygonMesh& mesh = Make("", faces).mesh;
    const auto left = LeftFaces(mesh);
    for (const auto& [edge, face] : left) {
      ASSERT_TRUE(left.contains({edge.second, edge.first})) << "face " << face;
    }
    EXPECT_TRUE(EveryVertexIsOneFan(mesh));
    const std::vector<uint32_t> one_label(mesh.NumFaces(), 0);
    EXPECT_EQ(PiecesOf(mesh, one_label)[0], 1);
    EXPECT_EQ(mesh.NumVertices() + mesh.NumFaces(), left.size() / 2 + 2);
  }
}

TEST_P(EverySample, FacesOutwards) {
  for (const std::string& pose : Poses()) {
    const PolygonMesh& mesh = Make(pose, 5000).mesh;
    double volume = 0;
    for (size_t f = 0; f < mesh.NumFaces(); ++f) {
      volume += AreaVectorOf(mesh, f).dot(PointOf(mesh, mesh.Face(f)[0])) / 3;
    }
    EXPECT_GT(volume, 0.05) << pose;
  }
}

TEST_P(EverySample, HasWellShapedFacesAtRest) {
  for (const uint32_t faces : {5000u, 10000u, 50000u}) {
    const PolygonMesh& mesh = Make("", faces).mesh;
    size_t slim = 0;
    for (size_t f = 0; f < mesh.NumFaces(); ++f) {
      const double least = LeastAngle(mesh, f);
      ASSERT_GT(least, 4) << "face " << f << " of " << faces;
      slim += least < 25;
    }
    EXPECT_LT(slim, 0.01 * faces) << faces;
  }
}

TEST_P(EverySample, KeepsItsFacesAndNearlyItsLengthsInEveryPose) {
  const PolygonMesh& rest = Make("rest", 5000).mesh;
  for (const std::string& pose : Poses()) {
    const PolygonMesh& posed = Make(pose, 5000).mesh;
    ASSERT_EQ(posed.face_vertices, rest.face_vertices) << pose;
    ASSERT_EQ(posed.NumVertices(), rest.NumVertices()) << pose;
    size_t edges = 0, stretched = 0;
    for (size_t f = 0; f < rest.NumFaces(); ++f) {
      const Triangle t = TriangleOf(rest, f);
      EXPECT_GT(AreaVectorOf(posed, f).norm(), 1e-6) << pose << " face " << f;
      for (int i = 0; i < 3; ++i) {
        const uint32_t u = t[i], v = t[(i + 1) % 3];
        const double ratio = (PointOf(posed, u) - PointOf(posed, v)).norm() /
                             (PointOf(rest, u) - PointOf(rest, v)).norm();
        ++edges;
        stretched += std::abs(ratio - 1) > 0.15;
      }
    }
    EXPECT_LT(stretched, 0.15 * edges) << pose;
    EXPECT_EQ(posed.positions == rest.positions, pose == "rest");
  }
}

TEST_P(EverySample, HasPartsInOnePieceOfSensibleArea) {
  for (const uint32_t faces : {5000u, 7778u, 10000u, 50000u}) {
    const Sample& sample = Make("", faces);
    const auto pieces = PiecesOf(sample.mesh, sample.face_parts);
    ASSERT_EQ(pieces.size(), sample.part_names.size());
    for (const auto& [part, count] : pieces) {
      EXPECT_EQ(count, 1) << sample.part_names[part] << " at " << faces;
    }
    const std::vector<double> areas = AreaOfParts(sample);
    EXPECT_THAT(areas, Each(::testing::Gt(0.04)));
    EXPECT_GT(areas[0], 0.2);
    EXPECT_LT(areas[0], 0.6);
  }
}

TEST_P(EverySample, HasPartsThatDependOnNoFineness) {
  const std::vector<double> fine = AreaOfParts(Make("", 50000));
  for (const uint32_t faces : {5000u, 7778u, 10000u}) {
    EXPECT_THAT(AreaOfParts(Make("", faces)),
                Pointwise(::testing::DoubleNear(0.01), fine))
        << faces;
  }
}

TEST_P(EverySample, HasPartsThatDependOnNoPose) {
  const Sample& rest = Make("rest", 5000);
  for (const std::string& pose : Poses()) {
    EXPECT_EQ(Make(pose, 5000).face_parts, rest.face_parts) << pose;
  }
}

TEST_P(EverySample, IsTheSameEveryTime) {
  const std::string pose = Poses().back();
  const Sample one = MakeNew(pose, 6000);
  const Sample two = MakeNew(pose, 6000);
  EXPECT_EQ(one.mesh.positions, two.mesh.positions);
  EXPECT_EQ(one.mesh.face_vertices, two.mesh.face_vertices);
  EXPECT_EQ(one.face_parts, two.face_parts);
}

TEST_P(EverySample, HasAtLeastThreePosesBeginningWithRest) {
  const std::vector<std::string> poses = Poses();
  EXPECT_GE(poses.size(), 3u);
  EXPECT_EQ(poses.front(), "rest");
  EXPECT_EQ(std::set<std::string>(poses.begin(), poses.end()).size(),
            poses.size());
  EXPECT_EQ(Make("", 5000).mesh.positions, Make("rest", 5000).mesh.positions);
}

TEST(SamplesTest, KnowsTheLimbsOfItsCreatures) {
  const auto parts_of = [](const std::string& name) {
    return MakeSample(name, "", 5000).value().part_names;
  };
  EXPECT_THAT(parts_of("humanoid"),
              ::testing::ElementsAre("torso", "head", "left_arm", "right_arm",
                                     "left_leg", "right_leg"));
  EXPECT_THAT(parts_of("quadruped"), ::testing::SizeIs(7));
  EXPECT_THAT(parts_of("hand"), ::testing::SizeIs(6));
  EXPECT_THAT(parts_of("octopus"), ::testing::SizeIs(9));
}

// A limb that took a piece of the body would be greater than its like.
TEST(SamplesTest, GivesLikeLimbsLikeAreas) {
  for (const auto& [name, first, count] :
       {std::tuple("humanoid", 2, 2), std::tuple("humanoid", 4, 2),
        std::tuple("quadruped", 2, 2), std::tuple("quadruped", 4, 2),
        std::tuple("octopus", 1, 8)}) {
    const std::vector<double> areas =
        AreaOfParts(MakeSample(name, "", 10000).value());
    for (int i = first; i < first + count; ++i) {
      EXPECT_NEAR(areas[i] / areas[first], 1, 0.05) << name << " part " << i;
    }
  }
}

// The left is +x when y is up and the creature looks along +z.
TEST(SamplesTest, TellsLeftFromRight) {
  const Sample sample = MakeSample("humanoid", "", 5000).value();
  std::map<std::string, double> least, greatest;
  for (size_t f = 0; f < sample.mesh.NumFaces(); ++f) {
    const std::string& name = sample.part_names[sample.face_parts[f]];
    const double x = PointOf(sample.mesh, sample.mesh.Face(f)[0]).x();
    least[name] = std::min(least[name], x);
    greatest[name] = std::max(greatest[name], x);
  }
  EXPECT_GT(greatest["left_arm"], 0.6);
  EXPECT_LT(least["right_arm"], -0.6);
  EXPECT_GT(greatest["left_leg"], 0.15);
  EXPECT_LT(least["right_leg"], -0.15);
}

TEST(SamplesTest, NamesTheSamplesThatThereAre) {
  const auto sample = MakeSample("unicorn", "", 10000);
  EXPECT_EQ(sample.status().code(), absl::StatusCode::kInvalidArgument);
  const std::string message(sample.status().message());
  EXPECT_THAT(message, HasSubstr("\"unicorn\""));
  for (const std::string& name : Names()) {
    EXPECT_THAT(message, HasSubstr(name));
  }
}

TEST(SamplesTest, NamesThePosesThatThereAre) {
  const auto sample = MakeSample("humanoid", "flying", 10000);
  EXPECT_EQ(sample.status().code(), absl::StatusCode::kInvalidArgument);
  const std::string message(sample.status().message());
  EXPECT_THAT(message, HasSubstr("\"flying\""));
  for (const std::string& pose : ListSamples().front().poses) {
    EXPECT_THAT(message, HasSubstr(pose));
  }
}

TEST(SamplesTest, RefusesTooFewAndTooManyFaces) {
  for (const uint32_t faces : {0u, 4999u, 50001u, 4294967295u}) {
    const auto sample = MakeSample("hand", "", faces);
    EXPECT_EQ(sample.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(sample.status().message()),
                HasSubstr("5000 to 50000"));
  }
}

}  // namespace
}  // namespace marrow
