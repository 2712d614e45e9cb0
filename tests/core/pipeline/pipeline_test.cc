#include "core/pipeline/pipeline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/base/error_reason.h"
#include "core/spectrum/solver.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/draco_encode.h"
#include "tests/testing/invariants.h"
#include "tests/testing/run.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

SegmentationOptions FewPairs() {
  SegmentationOptions options;
  options.method = Method::kPaper;
  options.eigen_pairs = 60;
  return options;
}

// Counts its calls and remembers the pairs of the one mesh it is asked for.
class RememberingSource : public EigenPairSource {
 public:
  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) override {
    ++calls;
    if (pairs == nullptr) {
      ++solved;
      auto found = solver_.Get(mesh, count, cancel, progress);
      if (!found.ok()) return found;
      pairs = *found;
    }
    return pairs;
  }

  int calls = 0;
  int solved = 0;
  std::shared_ptr<const EigenPairs> pairs;

 private:
  SolverEigenPairSource solver_;
};

absl::Status RunWith(const std::string& bytes,
                     const SegmentationOptions& options, Sink& sink,
                     EigenPairSource& source) {
  const CancelToken cancel;
  return Run(bytes, MeshLimits(), options, source, cancel, sink);
}

class WholeSource : public EigenPairSource {
 public:
  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) override {
    return solver_.Get(mesh, count, cancel, progress);
  }

 protected:
  SolverEigenPairSource solver_;
};

// Counts the pairs that were taken from it in pieces.
class CountedStreams : public WholeSource {
 public:
  std::unique_ptr<EigenPairStream> Open(const CanonicalMesh& mesh,
                                        uint32_t count) override {
    return std::make_unique<Stream>(solver_.Open(mesh, count), most);
  }

  uint32_t most = 0;

 private:
  class Stream : public EigenPairStream {
   public:
    Stream(std::unique_ptr<EigenPairStream> stream, uint32_t& most)
        : stream_(std::move(stream)), most_(most) {}
    absl::StatusOr<std::shared_ptr<const EigenPairs>> UpTo(
        double bound, const CancelToken& cancel,
        const ProgressCallback& progress) override {
      auto pairs = stream_->UpTo(bound, cancel, progress);
      if (pairs.ok()) most_ = std::max(most_, (*pairs)->NumPairs());
      return pairs;
    }

   private:
    const std::unique_ptr<EigenPairStream> stream_;
    uint32_t& most_;
  };
};

class RunOnAnyShape : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(RunOnAnyShape, KeepsEveryPromise) {
  const RecordingSink run = RunOn(GetParam().mesh, FewPairs());
  const TriangleMesh& mesh = run.mesh.mesh;
  const Adjacency adjacency(mesh);
  ASSERT_GE(run.levels.size(), 1u);
  ExpectSoundTree(mesh, adjacency, run.tree, run.mesh.report.area, true);
  for (const RecordingSink::Level& level : run.levels) {
    SCOPED_TRACE(level.level);
    ExpectSoundTree(mesh, adjacency, level.tree, run.mesh.report.area, false);
    ExpectSoundSkeleton(mesh, adjacency, level.tree, level.level,
                        level.skeleton);
    const auto segments = level.tree.FaceSegments(level.level);
    EXPECT_EQ(segments, run.tree.FaceSegments(level.level));
    ASSERT_EQ(level.face_labels.size(), GetParam().mesh.NumFaces());
    for (size_t f = 0; f < level.face_labels.size(); ++f)
      EXPECT_EQ(level.face_labels[f], segments[run.mesh.face_map[f]]);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, RunOnAnyShape,
                         ::testing::ValuesIn(AllShapes()),
                         [](const auto& info) {
                           return TestNameOf(info.param);
                         });

TEST(PipelineTest, CallsTheSinkInOrder) {
  const RecordingSink run = RunOn(LimbCross(3), FewPairs());
  EXPECT_THAT(run.events,
              ElementsAre("mesh", "level 1", "level 2", "level 3", "tree"));
  EXPECT_TRUE(std::ranges::is_sorted(run.fractions));
  EXPECT_TRUE(std::ranges::is_sorted(run.stages));
  EXPECT_EQ(run.fractions.front(), 0);
  EXPECT_EQ(run.fractions.back(), 1);
  EXPECT_EQ(run.stages.front(), Stage::kMesh);
  EXPECT_EQ(run.stages.back(), Stage::kSegments);
}

TEST(PipelineTest, LevelsTakeThePairsTheyNeedAndSayTheSame) {
  CountedStreams pieces;
  class Sink : public RecordingSink {
   public:
    explicit Sink(const uint32_t& most) : most_(most) {}
    bool OnLevel(const LevelResult& level) override {
      most_at_level.push_back(most_);
      return RecordingSink::OnLevel(level);
    }
    std::vector<uint32_t> most_at_level;

   private:
    const uint32_t& most_;
  };
  for (const TriangleMesh& mesh :
       {LimbCross(4), Apart(LimbCross(3), Icosphere(3))}) {
    const std::string bytes = EncodeDraco(mesh);
    SegmentationOptions options;
    options.method = Method::kPaper;
    pieces.most = 0;
    RecordingSink at_once;
    Sink stepwise(pieces.most);
    // Has no streams of its own: gives all pairs at once.
    WholeSource whole;
    ASSERT_TRUE(RunWith(bytes, options, stepwise, pieces).ok());
    ASSERT_TRUE(RunWith(bytes, options, at_once, whole).ok());
    EXPECT_EQ(stepwise.events, at_once.events);
    ASSERT_GE(stepwise.levels.size(), 2u);
    for (size_t l = 0; l < stepwise.levels.size(); ++l)
      EXPECT_EQ(stepwise.levels[l].face_labels, at_once.levels[l].face_labels);
    EXPECT_LT(stepwise.most_at_level[0], 40u);
    EXPECT_GT(pieces.most, stepwise.most_at_level[0]);
  }
}

TEST(PipelineTest, MergingTakesThePairsOfItsPiecesAndSaysTheSame) {
  for (const TriangleMesh& mesh :
       {LimbCross(4), Apart(LimbCross(3), Icosphere(3))}) {
    const std::string bytes = EncodeDraco(mesh);
    SegmentationOptions options;
    options.method = Method::kMerge;
    CountedStreams pieces;
    WholeSource whole;
    RecordingSink stepwise, at_once;
    ASSERT_TRUE(RunWith(bytes, options, stepwise, pieces).ok());
    ASSERT_TRUE(RunWith(bytes, options, at_once, whole).ok());
    EXPECT_EQ(stepwise.events, at_once.events);
    ExpectSameTree(stepwise.tree, at_once.tree);
    ASSERT_EQ(stepwise.levels.size(), at_once.levels.size());
    for (size_t l = 0; l < stepwise.levels.size(); ++l)
      EXPECT_EQ(stepwise.levels[l].face_labels, at_once.levels[l].face_labels);
    EXPECT_LT(pieces.most, 150u);
  }
}

TEST(PipelineTest, AMeshThatCannotBeSplitHasOneLevelOfOneNode) {
  const RecordingSink run = RunOn(SingleTriangle(), {});
  EXPECT_THAT(run.events, ElementsAre("mesh", "level 1", "tree"));
  EXPECT_THAT(run.levels[0].face_labels, ElementsAre(0));
  EXPECT_THAT(run.levels[0].point_labels, ElementsAre(0, 0, 0));
  EXPECT_EQ(run.levels[0].skeleton.joints.size(), 1u);
  ASSERT_EQ(run.tree.nodes.size(), 1u);
  EXPECT_EQ(run.tree.nodes[0].stop_reason, StopReason::kTooSmall);
}

TEST(PipelineTest, GivesAsManyLevelsAsAskedFor) {
  SegmentationOptions options = FewPairs();
  for (uint32_t levels : {1u, 2u}) {
    options.levels = levels;
    EXPECT_EQ(RunOn(LimbCross(3), options).levels.size(), levels);
  }
}

TEST(PipelineTest, StopsOnceTheSinkHasHadEnough) {
  RememberingSource source;
  const std::string bytes = EncodeDraco(LimbCross(2));
  for (const char* event : {"progress", "mesh", "level 1", "level 2", "tree"}) {
    RecordingSink sink(event);
    EXPECT_EQ(RunWith(bytes, FewPairs(), sink, source).code(),
              absl::StatusCode::kCancelled)
        << event;
    EXPECT_EQ(sink.calls_after_refusal, 0u) << event;
  }
}

// Cancels by the token when the solver reports.
class CancellingSink : public RecordingSink {
 public:
  explicit CancellingSink(CancelToken& cancel) : cancel_(cancel) {}
  bool OnProgress(Stage stage, double fraction) override {
    if (stage == Stage::kSpectrum) cancel_.Cancel();
    return RecordingSink::OnProgress(stage, fraction);
  }

 private:
  CancelToken& cancel_;
};

TEST(PipelineTest, StopsOnceTheTokenIsCancelled) {
  CancelToken cancel;
  CancellingSink sink(cancel);
  SolverEigenPairSource solver;
  EXPECT_EQ(marrow::Run(EncodeDraco(LimbCross(3)), MeshLimits(), FewPairs(),
                        solver, cancel, sink)
                .code(),
            absl::StatusCode::kCancelled);
  EXPECT_THAT(sink.events, ElementsAre("mesh"));
}

TEST(PipelineTest, ChecksTheOptionsBeforeAnything) {
  RememberingSource source;
  RecordingSink sink;
  SegmentationOptions options;
  options.method = Method::kPaper;
  options.split.kappa = -1;
  const absl::Status status =
      RunWith(EncodeDraco(Tetrahedron()), options, sink, source);
  EXPECT_EQ(FieldOf(status), "options.kappa");
  EXPECT_TRUE(sink.events.empty());
  EXPECT_TRUE(sink.fractions.empty());
  EXPECT_EQ(source.calls, 0);
}

TEST(PipelineTest, RefusesWhatIsNoMesh) {
  RememberingSource source;
  for (const std::string& bytes : {std::string(), std::string("OFF\n3 1 0\n"),
                                   EncodeDraco(Icosphere(1)).substr(0, 200)}) {
    RecordingSink sink;
    const absl::Status status = RunWith(bytes, FewPairs(), sink, source);
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(ReasonOf(status), kReasonDracoDecodeFailed) << status;
    EXPECT_TRUE(sink.events.empty());
  }
  TriangleMesh flat = Grid(2, 2);
  flat.positions.col(1).setZero();
  RecordingSink sink;
  const absl::Status status =
      RunWith(EncodeDraco(flat), FewPairs(), sink, source);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ReasonOf(status), kReasonMeshRejected) << status;
  EXPECT_EQ(source.calls, 0);
}

TEST(PipelineTest, KnownPairsGiveTheSameBytes) {
  const std::string bytes = EncodeDraco(LimbCross(3));
  RememberingSource source;
  RecordingSink cold, warm;
  ASSERT_TRUE(RunWith(bytes, FewPairs(), cold, source).ok());
  ASSERT_TRUE(RunWith(bytes, FewPairs(), warm, source).ok());
  EXPECT_EQ(source.calls, 2);
  EXPECT_EQ(source.solved, 1);
  EXPECT_EQ(cold.events, warm.events);
  ExpectSameTree(cold.tree, warm.tree);
  for (size_t i = 0; i < cold.levels.size(); ++i) {
    EXPECT_EQ(cold.levels[i].face_labels, warm.levels[i].face_labels);
    EXPECT_EQ(cold.levels[i].point_labels, warm.levels[i].point_labels);
    ExpectSameSkeleton(cold.levels[i].skeleton, warm.levels[i].skeleton);
  }
}

TEST(PipelineTest, FollowsEveryFaceAndPointOfThePayload) {
  const TriangleMesh clean = LimbCross(2);
  TriangleMesh mesh = clean;
  const uint32_t n = mesh.NumVertices(), m = mesh.NumFaces();
  const auto [a, b, c] = mesh.faces[7];
  // A point that no face has, a twin of a, and a point used by a dropped face.
  mesh.positions.conservativeResize(n + 3, 3);
  mesh.positions.row(n) << 0.25, 0.25, 0.25;
  mesh.positions.row(n + 1) = mesh.positions.row(a);
  mesh.positions.row(n + 2) << 0.5, 0.5, 0.5;
  mesh.faces.push_back({a, b, b});              // degenerate, on face 7's edge
  mesh.faces.push_back({c, b, n + 1});          // face 7, turned over
  mesh.faces.push_back({n + 2, n + 2, n + 2});  // nowhere near
  const RecordingSink expected = RunOn(clean, FewPairs());
  const RecordingSink run = RunOn(mesh, FewPairs());
  ASSERT_EQ(run.levels.size(), expected.levels.size());
  EXPECT_EQ(run.mesh.report.degenerate_faces, 2u);
  EXPECT_EQ(run.mesh.report.duplicate_faces, 1u);
  for (size_t i = 0; i < run.levels.size(); ++i) {
    const auto& faces = run.levels[i].face_labels;
    const auto& points = run.levels[i].point_labels;
    ASSERT_EQ(faces.size(), m + 3);
    ASSERT_EQ(points.size(), n + 3);
    // An edge has two faces; the degenerate one may go with either.
    std::set<uint32_t> at_edge;
    for (uint32_t f = 0; f < m; ++f)
      if (std::ranges::count(clean.faces[f], a) &&
          std::ranges::count(clean.faces[f], b))
        at_edge.insert(faces[f]);
    EXPECT_TRUE(at_edge.count(faces[m]));
    EXPECT_EQ(faces[m + 1], faces[7]);
    EXPECT_EQ(points[n], kNoIndex);
    EXPECT_EQ(points[n + 1], points[a]);
    EXPECT_EQ(points[n + 2], kNoIndex);
    EXPECT_TRUE(std::equal(faces.begin(), faces.begin() + m,
                           expected.levels[i].face_labels.begin()));
    EXPECT_TRUE(std::equal(points.begin(), points.begin() + n,
                           expected.levels[i].point_labels.begin()));
  }
}

TEST(PipelineTest, APointHasTheLabelWithMostAreaAroundIt) {
  const TriangleMesh mesh = Rounded(LimbCross(2));
  const RecordingSink run = RunOn(mesh, FewPairs());
  const Adjacency adjacency(mesh);
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    std::map<uint32_t, double> area;
    for (uint32_t f : adjacency.VertexFaces(v)) {
      const Eigen::Vector3d p = mesh.Position(mesh.faces[f][0]);
      const Eigen::Vector3d x = mesh.Position(mesh.faces[f][1]) - p;
      const Eigen::Vector3d y = mesh.Position(mesh.faces[f][2]) - p;
      area[run.levels[0].face_labels[f]] += x.cross(y).norm();
    }
    const double most = std::ranges::max_element(area, [](auto& x, auto& y) {
                          return x.second < y.second;
                        })->second;
    EXPECT_GE(area.at(run.levels[0].point_labels[v]), most * (1 - 1e-6)) << v;
  }
}

TEST(PointOfVertexTest, IsTheLeastPointAtTheVertex) {
  TriangleMesh mesh = Grid(1, 1);
  mesh.positions.conservativeResize(5, 3);
  mesh.positions.row(4) = mesh.positions.row(0);
  mesh.faces[1][0] = 4;
  const CanonicalMesh canonical = CanonicalOf(mesh);
  ASSERT_EQ(canonical.mesh.NumVertices(), 4u);
  const auto points = PointOfVertex(canonical);
  EXPECT_THAT(points, ElementsAre(0, 1, 2, 3));
}

}  // namespace
}  // namespace marrow
