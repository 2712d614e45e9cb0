#include "core/pipeline/segmented_mesh.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "core/base/error_reason.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/invariants.h"
#include "tests/testing/run.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

SegmentationOptions Options(Method method, uint32_t levels = 3) {
  SegmentationOptions options;
  options.method = method;
  options.eigen_pairs = 60;
  options.levels = levels;
  return options;
}

void ExpectSoundSkeleton(const CutResult& cut) {
  std::set<uint32_t> centres;
  for (uint32_t j = 0; j < cut.skeleton.joints.size(); ++j) {
    const Joint& joint = cut.skeleton.joints[j];
    EXPECT_EQ(joint.parent == kNoIndex, j == 0);
    if (j > 0) {
      EXPECT_LT(joint.parent, j);
    }
    if (!joint.articulation) {
      EXPECT_TRUE(centres.insert(joint.segments.at(0)).second);
    }
  }
  EXPECT_EQ(centres.size(), cut.segments.size());
}

// What holds of every cut, however it was asked for.
void ExpectSoundCut(const SegmentedMesh& mesh, const CutResult& cut) {
  std::map<uint32_t, std::vector<uint32_t>> faces;
  const CanonicalMesh& canonical = mesh.canonical();
  ASSERT_EQ(cut.face_labels.size(), canonical.face_map.size());
  ASSERT_EQ(cut.point_labels.size(), canonical.point_map.size());
  for (size_t f = 0; f < cut.face_labels.size(); ++f)
    faces[cut.face_labels[f]].push_back(canonical.face_map[f]);
  ASSERT_EQ(faces.size(), cut.segments.size());
  double area = 0;
  size_t i = 0;
  for (auto& [id, own] : faces) {
    const CutResult::Segment& segment = cut.segments[i++];
    SCOPED_TRACE(::testing::Message() << "segment " << id);
    EXPECT_EQ(segment.id, id);
    EXPECT_EQ(segment.decoded_faces, own.size());
    area += segment.area;
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    const std::vector<uint32_t> vertices = VerticesOf(canonical.mesh, own);
    EXPECT_FALSE(segment.medial_structure.empty());
    EXPECT_TRUE(std::includes(vertices.begin(), vertices.end(),
                              segment.medial_structure.begin(),
                              segment.medial_structure.end()));
    if (id < mesh.tree().nodes.size()) {
      EXPECT_EQ(mesh.tree().nodes[id].faces, own);
    } else {
      for (const SegmentNode& node : mesh.tree().nodes)
        EXPECT_NE(node.faces, own);
      ASSERT_LT(segment.parent, mesh.tree().nodes.size());
      const SegmentNode& parent = mesh.tree().nodes[segment.parent];
      EXPECT_TRUE(std::includes(parent.faces.begin(), parent.faces.end(),
                                own.begin(), own.end()));
      EXPECT_LE(segment.salience, parent.salience);
    }
  }
  EXPECT_NEAR(area, canonical.report.area, 1e-9 * canonical.report.area);
  ExpectSoundSkeleton(cut);
}

// Whether every label of `fine` lies in one of `coarse`.
bool Refines(const CutResult& fine, const CutResult& coarse) {
  std::map<uint32_t, uint32_t> into;
  for (size_t f = 0; f < fine.face_labels.size(); ++f)
    if (into.emplace(fine.face_labels[f], coarse.face_labels[f])
            .first->second != coarse.face_labels[f])
      return false;
  return true;
}

struct Named {
  const char* name;
  TriangleMesh mesh;
};

// A body with limbs; one with a speck that is attached; two bodies.
std::vector<Named> Meshes() {
  return {{"cross", LimbCross(4)},
          {"speck", Apart(LimbCross(4), Scaled(Tetrahedron(), 0.01))},
          {"bodies", Apart(LimbCross(3), Dumbbell(1, 24))}};
}

class EveryCut : public ::testing::TestWithParam<std::tuple<size_t, Method>> {
 protected:
  const RecordingSink run_ = RunOn(Meshes()[std::get<0>(GetParam())].mesh,
                                   Options(std::get<1>(GetParam())));
  const SegmentedMesh& mesh_ = *run_.segmented;
  CutResult Cut(const CutSpec& spec) const {
    return *mesh_.Cut(spec, CancelToken());
  }
};

TEST_P(EveryCut, LevelsAreThoseThatWereStreamed) {
  for (const RecordingSink::Level& level : run_.levels) {
    const CutResult cut = Cut(CutSpec::AtLevel(level.level));
    EXPECT_EQ(cut.face_labels, level.face_labels);
    EXPECT_EQ(cut.point_labels, level.point_labels);
    ExpectSameSkeleton(cut.skeleton, level.skeleton);
    ExpectSoundCut(mesh_, cut);
  }
}

TEST_P(EveryCut, MoreSegmentsRefineFewerAndAreAtMostThatMany) {
  const size_t bodies = mesh_.canonical().report.bodies;
  CutResult coarser = Cut(CutSpec::Into(1));
  EXPECT_EQ(coarser.segments.size(), bodies);
  for (uint32_t n : {2u, 3u, 5u, 8u, 13u, 50u}) {
    const CutResult cut = Cut(CutSpec::Into(n));
    EXPECT_LE(cut.segments.size(), std::max<size_t>(n, bodies));
    EXPECT_TRUE(Refines(cut, coarser)) << n;
    ExpectSoundCut(mesh_, cut);
    coarser = cut;
  }
  EXPECT_GT(coarser.segments.size(), bodies);
}

TEST_P(EveryCut, NodesAreHeldOpenAndClosed) {
  CutSpec spec = CutSpec::AtLevel(3);
  spec.closed = {mesh_.tree().nodes[0].children.at(0)};
  const CutResult closed = Cut(spec);
  ExpectSoundCut(mesh_, closed);
  EXPECT_TRUE(Refines(Cut(CutSpec::AtLevel(3)), closed));
  spec = CutSpec::Into(1);
  spec.open = {0};
  const CutResult open = Cut(spec);
  ExpectSoundCut(mesh_, open);
  EXPECT_EQ(open.segments.size(), mesh_.tree().nodes[0].children.size());
}

TEST_P(EveryCut, ReplayTellsTheSame) {
  RecordingSink again;
  ASSERT_TRUE(Replay(run_.segmented, CancelToken(), again).ok());
  EXPECT_EQ(again.events, run_.events);
  ExpectSameTree(again.tree, run_.tree);
  for (size_t i = 0; i < again.levels.size(); ++i) {
    EXPECT_EQ(again.levels[i].face_labels, run_.levels[i].face_labels);
    EXPECT_EQ(again.levels[i].point_labels, run_.levels[i].point_labels);
    ExpectSameSkeleton(again.levels[i].skeleton, run_.levels[i].skeleton);
  }
  RecordingSink refusing("level 1");
  EXPECT_TRUE(
      absl::IsCancelled(Replay(run_.segmented, CancelToken(), refusing)));
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, EveryCut,
    ::testing::Combine(::testing::Range<size_t>(0, 3),
                       ::testing::Values(Method::kPaper, Method::kMerge)),
    [](const auto& info) {
      return std::string(Meshes()[std::get<0>(info.param)].name) +
             (std::get<1>(info.param) == Method::kPaper ? "Paper" : "Merge");
    });

TEST(SegmentedMeshTest, SaliencesCutBetweenTheLevels) {
  for (const Named& named : Meshes()) {
    const RecordingSink run = RunOn(named.mesh, Options(Method::kMerge));
    CutResult finer =
        *run.segmented->Cut(CutSpec::AtSalience(0), CancelToken());
    ExpectSoundCut(*run.segmented, finer);
    for (double salience : {0.2, 0.5, 0.8, 0.97, 1.0}) {
      const CutResult cut =
          *run.segmented->Cut(CutSpec::AtSalience(salience), CancelToken());
      ExpectSoundCut(*run.segmented, cut);
      EXPECT_TRUE(Refines(finer, cut)) << salience;
      for (const CutResult::Segment& segment : cut.segments)
        EXPECT_LT(segment.salience, salience);
      finer = cut;
    }
  }
}

// The medial structure of what is no node is found as the tree's are: a tree
// without levels below 1 measures the groups of level 2 anew.
TEST(SegmentedMeshTest, SegmentsThatAreNoNodesAreMeasuredAsNodes) {
  const RecordingSink deep = RunOn(LimbCross(4), Options(Method::kMerge, 3));
  const RecordingSink flat = RunOn(LimbCross(4), Options(Method::kMerge, 1));
  const CutResult nodes = *deep.segmented->Cut({}, CancelToken());
  const CutResult anew = *flat.segmented->Cut({}, CancelToken());
  std::map<uint32_t, const CutResult::Segment*> by_face;
  for (size_t f = 0; f < nodes.face_labels.size(); ++f)
    for (const CutResult::Segment& segment : nodes.segments)
      if (segment.id == nodes.face_labels[f])
        by_face[static_cast<uint32_t>(f)] = &segment;
  ASSERT_EQ(anew.segments.size(), nodes.segments.size());
  for (size_t f = 0; f < anew.face_labels.size(); ++f)
    for (const CutResult::Segment& segment : anew.segments)
      if (segment.id == anew.face_labels[f]) {
        const CutResult::Segment& node = *by_face[static_cast<uint32_t>(f)];
        ASSERT_EQ(segment.medial_structure, node.medial_structure);
        ASSERT_EQ(segment.area, node.area);
        ASSERT_EQ(segment.centroid, node.centroid);
        ASSERT_EQ(segment.salience, node.salience);
      }
}

TEST(SegmentedMeshTest, ErrorsNameTheField) {
  const RecordingSink run = RunOn(LimbCross(3), Options(Method::kMerge));
  CutSpec spec;
  spec.open = {1000};
  EXPECT_EQ(FieldOf(run.segmented->Cut(spec, CancelToken()).status()),
            "cut.open[0]");
}

TEST(SegmentedMeshTest, StopsOnceCancelled) {
  const RecordingSink run = RunOn(LimbCross(3), Options(Method::kMerge));
  CancelToken cancel;
  cancel.Cancel();
  EXPECT_TRUE(absl::IsCancelled(run.segmented->Cut({}, cancel).status()));
}

TEST(SegmentedMeshTest, KnowsItsMemory) {
  const RecordingSink small = RunOn(LimbCross(3), Options(Method::kMerge));
  const RecordingSink large = RunOn(LimbCross(6), Options(Method::kMerge));
  const double ratio = static_cast<double>(large.mesh.mesh.NumFaces()) /
                       static_cast<double>(small.mesh.mesh.NumFaces());
  EXPECT_NEAR(static_cast<double>(large.segmented->Bytes()) /
                  static_cast<double>(small.segmented->Bytes()),
              ratio, 0.1 * ratio);
  EXPECT_EQ(small.segmented->EigenPairCount(), 60u);
}

}  // namespace
}  // namespace marrow
