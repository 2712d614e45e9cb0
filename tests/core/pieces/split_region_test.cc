#include "core/pieces/split_region.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

#include "gtest/gtest.h"
#include "tests/testing/invariants.h"
#include "tests/testing/shapes.h"
#include "tests/testing/solved_mesh.h"

namespace marrow {
namespace {

RegionSplit Split(const SolvedMesh& solved, const std::vector<uint32_t>& faces,
                  const SplitOptions& options = {}) {
  const CancelToken cancel;
  return SplitRegion(solved.context(), faces, options, cancel).value();
}

void ExpectSoundSplit(const SolvedMesh& solved,
                      const std::vector<uint32_t>& region,
                      const RegionSplit& split) {
  if (split.pieces.empty()) {
    EXPECT_NE(split.stop_reason, StopReason::kNone);
    return;
  }
  EXPECT_EQ(split.stop_reason, StopReason::kNone);
  EXPECT_GE(split.pieces.size(), 2u);
  EXPECT_LE(split.pieces.size(), kMaxMedialStructures);
  EXPECT_GE(split.iterations, 1u);
  EXPECT_LE(split.iterations, kMaxIterations);
  const bool connected = CountPieces(solved.adjacency, region) == 1;
  std::vector<uint32_t> all;
  for (const Piece& piece : split.pieces) {
    EXPECT_TRUE(std::ranges::is_sorted(piece.faces));
    EXPECT_FALSE(piece.medial_structure.empty());
    const auto vertices = VerticesOf(solved.canonical.mesh, piece.faces);
    EXPECT_TRUE(std::ranges::includes(vertices, piece.medial_structure));
    if (connected) {
      EXPECT_EQ(CountPieces(solved.adjacency, piece.faces), 1u);
    }
    all.insert(all.end(), piece.faces.begin(), piece.faces.end());
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(all, region);
}

// The place of the piece that has the face whose first corner lies farthest in
// a direction.
size_t PieceOfTip(const SolvedMesh& solved, const RegionSplit& split,
                  const Eigen::RowVector3d& direction) {
  const TriangleMesh& mesh = solved.canonical.mesh;
  const auto height = [&](uint32_t f) {
    return mesh.positions.row(mesh.faces[f][0]).dot(direction);
  };
  uint32_t tip = 0;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (height(f) > height(tip)) tip = f;
  for (size_t p = 0; p < split.pieces.size(); ++p)
    if (std::ranges::count(split.pieces[p].faces, tip)) return p;
  return kNoIndex;
}

TEST(SplitRegionTest, TheBallsOfADumbbellArePulledApart) {
  const SolvedMesh solved = SolveMesh(Dumbbell(0.8, 20));
  SplitOptions options;
  // Nearly all of the surface lies at the mean distance from the neck.
  options.kappa = 0.8;
  const RegionSplit split = Split(solved, solved.AllFaces(), options);
  ExpectSoundSplit(solved, solved.AllFaces(), split);
  ASSERT_GE(split.pieces.size(), 2u);
  EXPECT_NE(PieceOfTip(solved, split, {1, 0, 0}),
            PieceOfTip(solved, split, {-1, 0, 0}));
}

TEST(SplitRegionTest, TheLimbsOfACreatureAreFound) {
  const SolvedMesh solved = SolveMesh(LimbCross(3));
  const RegionSplit split = Split(solved, solved.AllFaces());
  ExpectSoundSplit(solved, solved.AllFaces(), split);
  std::vector<size_t> places;
  for (const Eigen::RowVector3d& direction :
       {Eigen::RowVector3d(1, 0, 0), Eigen::RowVector3d(-1, 0, 0),
        Eigen::RowVector3d(0, 1, 0), Eigen::RowVector3d(0, 0, 1)})
    places.push_back(PieceOfTip(solved, split, direction));
  std::sort(places.begin(), places.end());
  EXPECT_EQ(std::unique(places.begin(), places.end()), places.end());
}

TEST(SplitRegionTest, IsSoundOnAnyShapeWithAnyOptions) {
  for (const auto& [name, mesh] : AllShapes()) {
    const SolvedMesh solved = SolveMesh(mesh, 40);
    for (const SplitOptions& options :
         {SplitOptions{}, SplitOptions{.kappa = 0.1}, SplitOptions{.kappa = 10},
          SplitOptions{.delta = 0.999},
          SplitOptions{.kappa = 0.5, .delta = 0.001},
          SplitOptions{.kappa = 0.5, .epsilon = 0}, SplitOptions{.epsilon = 1},
          SplitOptions{.tolerance = 0},
          SplitOptions{.kappa = 0.7, .tolerance = 0.5}}) {
      SCOPED_TRACE(::testing::Message()
                   << name << ", " << options.kappa << ' ' << options.delta
                   << ' ' << options.epsilon << ' ' << options.tolerance);
      const auto all = solved.AllFaces();
      ExpectSoundSplit(solved, all, Split(solved, all, options));
      const std::vector<uint32_t> half(all.begin(),
                                       all.begin() + (all.size() + 1) / 2);
      ExpectSoundSplit(solved, half, Split(solved, half, options));
    }
  }
}

TEST(SplitRegionTest, ARegionInTwoPiecesIsSplitBetweenThem) {
  const SolvedMesh solved = SolveMesh(Apart(LimbCross(2), Icosphere(2)));
  const RegionSplit split =
      Split(solved, solved.AllFaces(), SplitOptions{.kappa = 0.8});
  ExpectSoundSplit(solved, solved.AllFaces(), split);
  EXPECT_GE(split.pieces.size(), 2u);
}

TEST(SplitRegionTest, TooFewFacesAreNotSplit) {
  const SolvedMesh solved = SolveMesh(LimbCross(2));
  std::vector<uint32_t> faces = solved.AllFaces();
  faces.resize(kMinRegionFaces - 1);
  EXPECT_EQ(Split(solved, faces).stop_reason, StopReason::kTooSmall);
  faces = solved.AllFaces();
  faces.resize(kMinRegionFaces);
  EXPECT_NE(Split(solved, faces).stop_reason, StopReason::kTooSmall);
}

TEST(SplitRegionTest, FacesWithoutAreaAreNotSplit) {
  SolvedMesh solved = SolveMesh(LimbCross(1));
  solved.areas.assign(solved.areas.size(), 0.0);
  EXPECT_EQ(Split(solved, solved.AllFaces()).stop_reason,
            StopReason::kTooSmall);
}

TEST(SplitRegionTest, SaysWhenItWantsMorePairs) {
  const SolvedMesh solved = SolveMesh(LimbCross(2), 8);
  std::vector<uint32_t> faces = solved.AllFaces();
  faces.resize(faces.size() / 20);
  EXPECT_EQ(Split(solved, faces).stop_reason, StopReason::kTooFewEigenPairs);
}

// A medial structure that has every vertex leaves a negative mean distance.
TEST(SplitRegionTest, NothingIsLeftToSplitWhereTheMeanDistanceIsNegative) {
  SolvedMesh solved = SolveMesh(Icosphere(2));
  const RegionSplit split =
      Split(solved, solved.AllFaces(), SplitOptions{.epsilon = 1});
  EXPECT_TRUE(split.pieces.empty());
  EXPECT_EQ(split.stop_reason, StopReason::kOneSegment);
  EXPECT_EQ(split.iterations, 0u);
}

TEST(SplitRegionTest, GivesTheSameTwice) {
  for (const TriangleMesh& mesh : {Icosphere(3), LimbCross(2)}) {
    const SolvedMesh solved = SolveMesh(mesh, 60);
    const auto all = solved.AllFaces();
    const RegionSplit a = Split(solved, all, SplitOptions{.kappa = 0.5});
    const RegionSplit b = Split(solved, all, SplitOptions{.kappa = 0.5});
    ASSERT_EQ(a.pieces.size(), b.pieces.size());
    EXPECT_EQ(a.iterations, b.iterations);
    for (size_t p = 0; p < a.pieces.size(); ++p) {
      EXPECT_EQ(a.pieces[p].faces, b.pieces[p].faces);
      EXPECT_EQ(a.pieces[p].medial_structure, b.pieces[p].medial_structure);
    }
  }
}

// Of enough vertices for several ranges of them.
TEST(SplitRegionTest, GivesTheSameOnAnyNumberOfThreads) {
  const SolvedMesh solved = PretendToSolve(Icosphere(5), 20);
  const auto split = [&](int threads) {
    return SplitRegion(solved.context(), solved.AllFaces(),
                       SplitOptions{.kappa = 0.5}, CancelToken(), threads)
        .value();
  };
  const RegionSplit one = split(1);
  ASSERT_GT(one.pieces.size(), 1u);
  for (int threads : {2, 3}) {
    const RegionSplit more = split(threads);
    ASSERT_EQ(more.pieces.size(), one.pieces.size());
    EXPECT_EQ(more.iterations, one.iterations);
    for (size_t p = 0; p < one.pieces.size(); ++p) {
      EXPECT_EQ(more.pieces[p].faces, one.pieces[p].faces);
      EXPECT_EQ(more.pieces[p].medial_structure,
                one.pieces[p].medial_structure);
    }
  }
}

TEST(SplitRegionTest, CancelledBeforehand) {
  CancelToken cancel;
  cancel.Cancel();
  const SolvedMesh solved = SolveMesh(LimbCross(1));
  EXPECT_EQ(SplitRegion(solved.context(), solved.AllFaces(), {}, cancel)
                .status()
                .code(),
            absl::StatusCode::kCancelled);
}

TEST(SplitRegionTest, StopsWithinHalfASecondOfBeingCancelled) {
  const SolvedMesh solved = PretendToSolve(Icosphere(6), 40);
  CancelToken cancel;
  std::chrono::steady_clock::time_point cancelled_at;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    cancelled_at = std::chrono::steady_clock::now();
    cancel.Cancel();
  });
  const auto split =
      SplitRegion(solved.context(), solved.AllFaces(),
                  SplitOptions{.kappa = 0.1, .tolerance = 0}, cancel);
  const auto returned_at = std::chrono::steady_clock::now();
  canceller.join();
  EXPECT_EQ(split.status().code(), absl::StatusCode::kCancelled);
  EXPECT_LT(returned_at - cancelled_at, std::chrono::milliseconds(500));
}

TEST(MedialStructureOfTest, IsTheMiddleOfADumbbell) {
  const SolvedMesh solved = SolveMesh(Dumbbell(1, 20));
  const auto structure =
      MedialStructureOf(solved.context(), solved.AllFaces(), {});
  ASSERT_FALSE(structure.empty());
  for (uint32_t v : structure)
    EXPECT_LT(std::abs(solved.canonical.mesh.positions(v, 0)), 0.5) << v;
}

}  // namespace
}  // namespace marrow
