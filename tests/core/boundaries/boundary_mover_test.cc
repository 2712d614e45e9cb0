#include "core/boundaries/boundary_mover.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/boundaries/calibration.h"
#include "core/operators/laplacian.h"
#include "core/pieces/region.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

struct Body {
  explicit Body(TriangleMesh m) : mesh(std::move(m)) {}

  std::vector<uint32_t> Moved(std::vector<uint32_t> pieces) const {
    EXPECT_TRUE(MoveBoundaries(mesh, adjacency, FaceAreaShares(mesh), {},
                               curvature, kBandWidth, CancelToken(), pieces)
                    .ok());
    return pieces;
  }
  double X(uint32_t f) const {
    double x = 0;
    for (uint32_t v : mesh.faces[f]) x += mesh.Position(v).x() / 3;
    return x;
  }
  std::vector<uint32_t> Halves(double x) const {
    std::vector<uint32_t> halves;
    for (uint32_t f = 0; f < mesh.NumFaces(); ++f) halves.push_back(X(f) > x);
    return halves;
  }

  TriangleMesh mesh;
  Adjacency adjacency{mesh};
  Curvature curvature =
      Curvature::Measure(mesh, adjacency, CancelToken()).value();
};

// The x of the vertices between two pieces: least and greatest.
std::pair<double, double> BoundaryRange(const Body& body,
                                        const std::vector<uint32_t>& pieces) {
  std::pair<double, double> range = {1e9, -1e9};
  for (uint32_t e = 0; e < body.adjacency.NumEdges(); ++e) {
    const auto faces = body.adjacency.EdgeFaces(e);
    if (faces.size() != 2 || pieces[faces[0]] == pieces[faces[1]]) continue;
    for (uint32_t v : body.adjacency.EdgeVertices(e)) {
      const double x = body.mesh.Position(v).x();
      range = {std::min(range.first, x), std::max(range.second, x)};
    }
  }
  return range;
}

// The neck of the dumbbell ends near x = 0.5; a cut through the ball beyond
// slides down to it.
TEST(MoveBoundariesTest, SlidesIntoTheNeck) {
  const Body body(Dumbbell(1, 40));
  for (double x : {0.9, 1.2}) {
    const auto [low, high] = BoundaryRange(body, body.Moved(body.Halves(x)));
    EXPECT_GT(low, -0.7);
    EXPECT_LT(high, 0.7);
  }
}

TEST(MoveBoundariesTest, LosesNoPieceAndLeavesEachInOnePiece) {
  for (const NamedMesh& shape : AllShapes()) {
    const Body body(CanonicalOf(shape.mesh).mesh);
    // Slices: in one piece where the mesh is, more or less.
    std::vector<uint32_t> pieces;
    const double low = body.mesh.positions.col(0).minCoeff();
    const double width = body.mesh.positions.col(0).maxCoeff() - low;
    if (!(width > 0)) continue;
    for (uint32_t f = 0; f < body.mesh.NumFaces(); ++f)
      pieces.push_back(
          static_cast<uint32_t>(2.999 * (body.X(f) - low) / width));
    const std::set<uint32_t> before(pieces.begin(), pieces.end());
    if (*before.rbegin() + 1 != before.size()) continue;
    const std::vector<uint32_t> moved = body.Moved(pieces);
    EXPECT_EQ(std::set<uint32_t>(moved.begin(), moved.end()), before)
        << shape.name;
    EXPECT_EQ(body.Moved(pieces), moved) << shape.name;
    const auto count = [&](const std::vector<uint32_t>& labels) {
      return std::ranges::max(ConnectedPieces(body.adjacency, labels)) + 1;
    };
    if (count(std::vector<uint32_t>(pieces.size(), 0)) == 1) {
      EXPECT_EQ(count(moved), before.size()) << shape.name;
    }
  }
}

TEST(MoveBoundariesTest, BendingChangesNothing) {
  const Body flat(Grid(16, 8));
  TriangleMesh rolled = flat.mesh;
  for (Eigen::Index v = 0; v < rolled.positions.rows(); ++v) {
    const double x = flat.mesh.positions(v, 0);
    // The chord of a step is not its arc, but all of one length.
    rolled.positions(v, 0) = 4 * std::sin(x / 4);
    rolled.positions(v, 2) = 4 * std::cos(x / 4);
  }
  const std::vector<uint32_t> pieces = flat.Halves(5.3);
  EXPECT_EQ(Body(rolled).Moved(pieces), flat.Moved(pieces));
}

// A zigzag of 1 across a strip becomes straight; no farther than the breadth.
TEST(SmoothBoundariesTest, MakesAZigzagShortWithinItsBreadth) {
  const Body strip(Grid(40, 20));
  std::vector<uint32_t> zigzag;
  for (uint32_t f = 0; f < strip.mesh.NumFaces(); ++f) {
    const int row =
        static_cast<int>(strip.mesh.Position(strip.mesh.faces[f][0]).y());
    zigzag.push_back(strip.X(f) > (row % 4 < 2 ? 19 : 21));
  }
  const double unit = std::sqrt(40.0 * 20.0);
  for (const double breadth : {0.5, 3.0}) {
    std::vector<uint32_t> pieces = zigzag;
    ASSERT_TRUE(SmoothBoundaries(strip.mesh, strip.adjacency,
                                 FaceAreaShares(strip.mesh), {}, breadth / unit,
                                 CancelToken(), pieces)
                    .ok());
    const auto [low, high] = BoundaryRange(strip, pieces);
    if (breadth < 1) {
      EXPECT_EQ(std::pair(low, high), BoundaryRange(strip, zigzag));
    } else {
      EXPECT_LE(high - low, 1);
    }
  }
}

TEST(MoveBoundariesTest, StopsOnceCancelled) {
  const Body body(Grid(4, 4));
  std::vector<uint32_t> pieces = body.Halves(2);
  CancelToken cancel;
  cancel.Cancel();
  EXPECT_TRUE(absl::IsCancelled(
      MoveBoundaries(body.mesh, body.adjacency, FaceAreaShares(body.mesh), {},
                     body.curvature, kBandWidth, cancel, pieces)));
}

}  // namespace
}  // namespace marrow
