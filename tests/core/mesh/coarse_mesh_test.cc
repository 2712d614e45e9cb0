#include "core/mesh/coarse_mesh.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/mesh/adjacency.h"
#include "gtest/gtest.h"
#include "tests/testing/cpu_time.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using FacePairs = std::set<std::pair<uint32_t, uint32_t>>;

// Pairs of labels on the two sides of an edge.
FacePairs NeighbourLabels(const TriangleMesh& mesh,
                          const std::vector<uint32_t>& labels) {
  const Adjacency adjacency(mesh);
  FacePairs pairs;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    for (uint32_t f : adjacency.EdgeFaces(e))
      for (uint32_t g : adjacency.EdgeFaces(e))
        if (labels[f] < labels[g]) pairs.insert({labels[f], labels[g]});
  return pairs;
}

std::set<Triangle> CornerSets(const TriangleMesh& mesh) {
  std::set<Triangle> sets;
  for (Triangle face : mesh.faces) {
    std::sort(face.begin(), face.end());
    sets.insert(face);
  }
  return sets;
}

void ExpectMapsHold(const TriangleMesh& fine, const CoarseMesh& coarse) {
  const TriangleMesh& mesh = coarse.canonical.mesh;
  ASSERT_EQ(coarse.vertices.size(), mesh.NumVertices());
  EXPECT_TRUE(std::is_sorted(coarse.vertices.begin(), coarse.vertices.end()));
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
    EXPECT_EQ(mesh.Position(v), fine.Position(coarse.vertices[v]));
  ASSERT_EQ(coarse.faces.size(), mesh.NumFaces());
  ASSERT_EQ(coarse.coarse_face.size(), fine.NumFaces());
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    EXPECT_EQ(coarse.coarse_face[coarse.faces[f]], f);
  const CanonicalMesh canonical = CanonicalOf(mesh);
  EXPECT_EQ(canonical.mesh.positions, mesh.positions);
  EXPECT_EQ(CornerSets(canonical.mesh), CornerSets(mesh));
  EXPECT_TRUE(std::is_sorted(mesh.faces.begin(), mesh.faces.end()));
  for (const Triangle& face : mesh.faces)
    EXPECT_EQ(face[0], std::ranges::min(face));
  EXPECT_EQ(coarse.canonical.geometry_digest, GeometryDigestOf(mesh));

  // Patches are connected, and neighbours have neighbouring ones.
  const Adjacency adjacency(fine);
  DisjointSets patches(fine.NumFaces());
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    for (uint32_t f : adjacency.EdgeFaces(e))
      for (uint32_t g : adjacency.EdgeFaces(e))
        if (coarse.coarse_face[f] == coarse.coarse_face[g]) patches.Union(f, g);
  for (uint32_t f = 0; f < fine.NumFaces(); ++f)
    EXPECT_EQ(patches.Find(f),
              patches.Find(coarse.faces[coarse.coarse_face[f]]));
  std::vector<uint32_t> own(mesh.NumFaces());
  std::iota(own.begin(), own.end(), 0u);
  const FacePairs wanted = NeighbourLabels(mesh, own);
  const FacePairs found = NeighbourLabels(fine, coarse.coarse_face);
  EXPECT_TRUE(
      std::includes(found.begin(), found.end(), wanted.begin(), wanted.end()));
}

class CoarsenAnyShape : public testing::TestWithParam<NamedMesh> {};

TEST_P(CoarsenAnyShape, KeepsTopologyAndMaps) {
  const CanonicalMesh fine = CanonicalOf(GetParam().mesh);
  for (const uint32_t divisor : {1, 2, 8, 1000}) {
    SCOPED_TRACE(divisor);
    const CoarseMesh coarse =
        Coarsen(fine.mesh, fine.mesh.NumVertices() / divisor);
    ExpectMapsHold(fine.mesh, coarse);
    const MeshReport &before = fine.report, &after = coarse.canonical.report;
    EXPECT_EQ(after.euler_characteristic, before.euler_characteristic);
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.boundary_loops, before.boundary_loops);
    EXPECT_EQ(after.nonmanifold_edges, before.nonmanifold_edges);
    EXPECT_EQ(after.nonmanifold_vertices, before.nonmanifold_vertices);
    EXPECT_EQ(after.flipped_faces, before.flipped_faces);
    EXPECT_EQ(after.genus, before.genus);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, CoarsenAnyShape,
                         testing::ValuesIn(AllShapes()), [](const auto& info) {
                           return TestNameOf(info.param);
                         });

TEST(CoarsenTest, ReachesTheNumberAndKeepsTheShape) {
  const CanonicalMesh fine = CanonicalOf(Icosphere(6));  // 40,962 vertices
  const CoarseMesh coarse = Coarsen(fine.mesh, 2'000);
  EXPECT_EQ(coarse.canonical.mesh.NumVertices(), 2'000u);
  EXPECT_NEAR(coarse.canonical.report.area / fine.report.area, 1, 0.01);
  EXPECT_EQ(coarse.canonical.report.sliver_faces, 0u);
  // Evenly: no patch has many times its share.
  std::vector<uint32_t> patch(coarse.faces.size(), 0);
  for (uint32_t f : coarse.coarse_face) ++patch[f];
  const double mean = 1.0 * fine.mesh.NumFaces() / coarse.faces.size();
  EXPECT_LT(*std::max_element(patch.begin(), patch.end()), 10 * mean);
}

// A body and limbs of different lengths, without a symmetry; all faces are
// equal but for where they are.
TriangleMesh Lattice() {
  return CubesSurface({{0, 0, 0},
                       {1, 0, 0},
                       {2, 0, 0},
                       {3, 0, 0},
                       {3, 1, 0},
                       {3, 2, 0},
                       {0, 0, 1}},
                      24);
}

// Of each vertex of `mesh`, in its own order, whether a coarse one is left.
std::vector<bool> LeftOf(const TriangleMesh& mesh, uint32_t num_vertices) {
  const CanonicalMesh fine = CanonicalOf(mesh);
  const CoarseMesh coarse = Coarsen(fine.mesh, num_vertices);
  std::vector<bool> is_left(fine.mesh.NumVertices(), false);
  for (uint32_t v : coarse.vertices) is_left[v] = true;
  std::vector<bool> left;
  for (uint32_t v : fine.point_map) left.push_back(is_left[v]);
  return left;
}

// Expects the coarse mesh of the moved mesh to be the coarse mesh moved.
void ExpectMovesWith(const TriangleMesh& mesh) {
  constexpr uint32_t kLeft = 8'000;
  TriangleMesh permuted = mesh, mirrored = mesh, moved = mesh;
  permuted.positions.col(0).swap(permuted.positions.col(2));
  mirrored.positions.col(0) *= -1;
  moved.positions.rowwise() += Eigen::RowVector3d(1, -20, 0.3);
  const TriangleMesh turned =
      Rotated(Scaled(mesh, 0.01), Eigen::Vector3d(1, 2, -0.7), 1.2);
  const std::vector<bool> left = LeftOf(mesh, kLeft);
  const auto count_lost = [&](const TriangleMesh& other) {
    const std::vector<bool> found = LeftOf(other, kLeft);
    uint32_t lost = 0;
    for (size_t v = 0; v < left.size(); ++v) lost += left[v] && !found[v];
    return lost;
  };
  constexpr uint32_t kFew = kLeft / 2000;
  EXPECT_LE(count_lost(permuted), kFew);
  EXPECT_LE(count_lost(mirrored), kFew);
  EXPECT_LE(count_lost(moved), kFew);
  EXPECT_LE(count_lost(Scaled(mesh, 0.01)), kFew);
  EXPECT_LE(count_lost(turned), kFew);
  // To float: that makes a few edges change places, and what follows of that.
  EXPECT_LE(count_lost(Rounded(turned)), kLeft / 100);
}

// Neither numbering, which follows the coordinates, nor rounding decides.
TEST(CoarsenTest, MovesWithTheMesh) { ExpectMovesWith(Lattice()); }

TEST(CoarsenTest, MovesWithAMeshOfEquallyBadFaces) {
  TriangleMesh mesh = Lattice();
  mesh.positions.col(0) *= 3;
  mesh.positions.col(2) *= 8;
  ExpectMovesWith(mesh);
}

TEST(CoarsenTest, LeavesAMeshThatIsSmallEnough) {
  const CanonicalMesh fine = CanonicalOf(LimbCross(3));
  const CoarseMesh coarse = Coarsen(fine.mesh, fine.mesh.NumVertices());
  EXPECT_EQ(coarse.canonical.geometry_digest, fine.geometry_digest);
}

// Two wheels of 200,000 spokes rim to rim: nothing may take the square of that.
TEST(CoarsenTest, IsQuickWhereAVertexHasVeryManyFaces) {
  constexpr uint32_t kSpokes = 200'000;
  TriangleMesh wheel;
  wheel.positions.resize(kSpokes + 2, 3);
  for (uint32_t i = 0; i < kSpokes; ++i) {
    const double angle = 2 * M_PI * i / kSpokes;
    wheel.positions.row(i) << std::cos(angle), std::sin(angle), 0;
    const uint32_t next = (i + 1) % kSpokes;
    wheel.faces.push_back({i, next, kSpokes});
    wheel.faces.push_back({next, i, kSpokes + 1});
  }
  wheel.positions.row(kSpokes) << 0, 0, 1;
  wheel.positions.row(kSpokes + 1) << 0, 0, -1;
  const CanonicalMesh fine = CanonicalOf(wheel);
  const double start = CpuSeconds();
  const CoarseMesh coarse = Coarsen(fine.mesh, 5'000);
  EXPECT_LT(CpuSeconds() - start, Allowed(5));
  EXPECT_EQ(coarse.canonical.mesh.NumVertices(), 5'000u);
}

}  // namespace
}  // namespace marrow
