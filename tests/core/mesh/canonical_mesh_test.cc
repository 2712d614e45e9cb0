#include "core/mesh/canonical_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "core/base/error_reason.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/mesh/draco_fixture.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

DecodedMesh MeshOf(const std::vector<std::array<double, 3>>& points,
                   std::vector<Triangle> faces) {
  DecodedMesh mesh;
  mesh.positions.resize(points.size(), 3);
  for (size_t p = 0; p < points.size(); ++p) {
    mesh.positions.row(p) << points[p][0], points[p][1], points[p][2];
  }
  mesh.faces = std::move(faces);
  return mesh;
}

CanonicalMesh Canonical(const DecodedMesh& decoded) {
  auto canonical = Canonicalize(decoded);
  EXPECT_TRUE(canonical.ok()) << canonical.status();
  return canonical.ok() ? *std::move(canonical) : CanonicalMesh();
}

void ExpectRejected(const DecodedMesh& decoded, const std::string& text) {
  const absl::Status status = Canonicalize(decoded).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ReasonOf(status), kReasonMeshRejected);
  EXPECT_THAT(std::string(status.message()), HasSubstr(text));
}

// The same surface with other numbers: points and faces shuffled, corners
// rotated, and every third point split in two.
DecodedMesh Renumbered(const DecodedMesh& mesh, uint32_t seed) {
  std::mt19937 random(seed);
  const uint32_t points = mesh.positions.rows();
  std::vector<uint32_t> sources(points);
  std::iota(sources.begin(), sources.end(), 0);
  for (uint32_t p = 0; p < points; p += 3) sources.push_back(p);
  std::shuffle(sources.begin(), sources.end(), random);
  std::vector<std::vector<uint32_t>> copies(points);
  DecodedMesh result;
  result.positions.resize(sources.size(), 3);
  for (uint32_t p = 0; p < sources.size(); ++p) {
    copies[sources[p]].push_back(p);
    result.positions.row(p) = mesh.positions.row(sources[p]);
  }
  for (Triangle face : mesh.faces) {
    for (uint32_t& v : face) v = copies[v][random() % copies[v].size()];
    std::rotate(face.begin(), face.begin() + random() % 3, face.end());
    result.faces.push_back(face);
  }
  std::shuffle(result.faces.begin(), result.faces.end(), random);
  return result;
}

std::array<uint32_t, 3> Sorted(Triangle face) {
  std::sort(face.begin(), face.end());
  return face;
}

void ExpectMapsAreRight(const DecodedMesh& decoded, const CanonicalMesh& c) {
  ASSERT_EQ(c.point_map.size(), decoded.positions.rows());
  for (uint32_t p = 0; p < c.point_map.size(); ++p) {
    if (c.point_map[p] == kNoIndex) continue;
    EXPECT_EQ(c.mesh.positions.row(c.point_map[p]), decoded.positions.row(p));
  }
  ASSERT_EQ(c.face_map.size(), decoded.faces.size());
  for (uint32_t f = 0; f < c.face_map.size(); ++f) {
    ASSERT_LT(c.face_map[f], c.mesh.NumFaces());
    Triangle face = decoded.faces[f];
    for (uint32_t& v : face) v = c.point_map[v];
    face = Sorted(face);
    if (face[0] == face[1] || face[1] == face[2]) continue;
    EXPECT_EQ(Sorted(c.mesh.faces[c.face_map[f]]), face);
  }
}

// A torus with a flipped twin of every fifth face and a degenerate face on
// every seventh.
DecodedMesh DirtyTorus() {
  DecodedMesh mesh = Torus(9, 11);
  const std::vector<Triangle> clean = mesh.faces;
  for (size_t f = 0; f < clean.size(); f += 5) {
    mesh.faces.push_back({clean[f][0], clean[f][2], clean[f][1]});
  }
  for (size_t f = 0; f < clean.size(); f += 7) {
    mesh.faces.push_back({clean[f][0], clean[f][1], clean[f][1]});
  }
  return mesh;
}

// Bit by bit from the sign down, by hand: interleaved, the bits of b's
// coordinates must be the greater number.
bool IsBeforeOnCurve(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  auto bit = [](double x, int i) {
    if (i == 63) return x >= 0;
    const auto fixed = static_cast<uint64_t>(std::ldexp(std::abs(x), 55));
    return ((fixed >> i & 1) == 1) == (x >= 0);
  };
  for (int i = 63; i >= 0; --i)
    for (int axis = 0; axis < 3; ++axis)
      if (bit(a[axis], i) != bit(b[axis], i)) return bit(b[axis], i);
  return false;
}

TEST(CanonicalMeshTest, IsSortedAndRotated) {
  const CanonicalMesh c = Canonical(Renumbered(Torus(9, 11), 1));
  ASSERT_EQ(c.mesh.NumVertices(), 99u);
  ASSERT_EQ(c.mesh.NumFaces(), 198u);
  for (uint32_t v = 1; v < c.mesh.NumVertices(); ++v)
    EXPECT_TRUE(IsBeforeOnCurve(c.mesh.Position(v - 1), c.mesh.Position(v)));
  for (const Triangle& face : c.mesh.faces) {
    EXPECT_EQ(face[0], std::min({face[0], face[1], face[2]}));
  }
  EXPECT_TRUE(std::is_sorted(c.mesh.faces.begin(), c.mesh.faces.end()));
}

// Or a body of several would be computed anew when it comes alone.
TEST(CanonicalMeshTest, PartsKeepTheirOrder) {
  const DecodedMesh part = Torus(9, 11);
  DecodedMesh both = part;
  const uint32_t count = part.positions.rows();
  both.positions.conservativeResize(2 * count, 3);
  both.positions.bottomRows(count) = 100 * part.positions;
  for (const Triangle& face : part.faces)
    both.faces.push_back({face[0] + count, face[1] + count, face[2] + count});
  const CanonicalMesh alone = Canonical(part), c = Canonical(both);
  uint32_t last = 0;
  for (uint32_t v = 0; v < count; ++v) {
    const auto at =
        std::find(alone.point_map.begin(), alone.point_map.end(), v);
    const uint32_t now = c.point_map[at - alone.point_map.begin()];
    EXPECT_TRUE(v == 0 || last < now);
    last = now;
  }
}

TEST(CanonicalMeshTest, NumberingCannotMatter) {
  const DecodedMesh dirty = DirtyTorus();
  const CanonicalMesh expected = Canonical(dirty);
  ExpectMapsAreRight(dirty, expected);
  EXPECT_EQ(expected.report.duplicate_faces, 40u);
  EXPECT_EQ(expected.report.degenerate_faces, 29u);
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    const DecodedMesh other = Renumbered(dirty, seed);
    const CanonicalMesh actual = Canonical(other);
    EXPECT_EQ(actual.mesh.positions, expected.mesh.positions);
    EXPECT_EQ(actual.mesh.faces, expected.mesh.faces);
    EXPECT_EQ(actual.geometry_digest, expected.geometry_digest);
    EXPECT_EQ(actual.report.area, expected.report.area);
    EXPECT_EQ(actual.report.welded_points, 33u);
    ExpectMapsAreRight(other, actual);
  }
}

// As programs leave them that write every corner of every face, rounded.
TEST(CanonicalMeshTest, ClosesCracks) {
  const DecodedMesh torus = Torus(9, 11);
  std::mt19937 random(5);
  DecodedMesh soup;
  soup.positions.resize(3 * torus.faces.size(), 3);
  for (const Triangle& face : torus.faces) {
    const auto first = static_cast<uint32_t>(3 * soup.faces.size());
    for (uint32_t i = 0; i < 3; ++i)
      for (int axis = 0; axis < 3; ++axis)
        soup.positions(first + i, axis) =
            torus.positions(face[i], axis) + 1e-7 * (random() * 0x1p-32);
    soup.faces.push_back({first, first + 1, first + 2});
  }
  const CanonicalMesh c = Canonical(soup);
  EXPECT_EQ(c.mesh.NumVertices(), 99u);
  EXPECT_EQ(c.report.components, 1u);
  EXPECT_EQ(c.report.boundary_edges, 0u);
  EXPECT_EQ(c.report.crack_points, 3 * 198u - 99u);
  for (uint32_t v : c.point_map) ASSERT_LT(v, 99u);
  EXPECT_EQ(Canonical(torus).report.crack_points, 0u);
}

// At a thousandth of an edge, where a tolerance of their own would close some
// of the corners and leave a sieve.
TEST(CanonicalMeshTest, ClosesASoupAsAWhole) {
  const TriangleMesh ball = marrow::Icosphere(3);
  std::mt19937 random(7);
  DecodedMesh soup;
  soup.positions.resize(3 * ball.faces.size(), 3);
  for (const Triangle& face : ball.faces) {
    const auto first = static_cast<uint32_t>(3 * soup.faces.size());
    for (uint32_t i = 0; i < 3; ++i)
      for (int axis = 0; axis < 3; ++axis)
        soup.positions(first + i, axis) =
            ball.positions(face[i], axis) + 2e-4 * (random() * 0x1p-32 - 0.5);
    soup.faces.push_back({first, first + 1, first + 2});
  }
  const CanonicalMesh c = Canonical(soup);
  EXPECT_EQ(c.mesh.NumVertices(), ball.NumVertices());
  EXPECT_EQ(c.report.components, 1u);
  EXPECT_EQ(c.report.boundary_edges, 0u);
}

// A gap of a thousandth is none.
TEST(CanonicalMeshTest, LeavesGapsOpen) {
  const CanonicalMesh c = Canonical(MeshOf({{0, 0, 0},
                                            {1, 0, 0},
                                            {0, 1, 0},
                                            {0, -1e-3, 0},
                                            {1, -1e-3, 0},
                                            {0, -1, 0}},
                                           {{0, 1, 2}, {3, 5, 4}}));
  EXPECT_EQ(c.mesh.NumVertices(), 6u);
  EXPECT_EQ(c.report.crack_points, 0u);
}

TEST(CanonicalMeshTest, RotatesFaces) {
  const auto c =
      Canonical(MeshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                       {{1, 0, 2}, {3, 0, 1}, {2, 0, 3}, {3, 1, 2}}));
  // In canonical order the points are (0,0,0), (0,0,1), (0,1,0), (1,0,0).
  EXPECT_THAT(c.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3},
                                        Triangle{0, 3, 1}, Triangle{1, 3, 2}));
  EXPECT_THAT(c.face_map, ElementsAre(1, 2, 0, 3));
  EXPECT_THAT(c.point_map, ElementsAre(0, 3, 2, 1));
  EXPECT_EQ(c.report.flipped_faces, 0u);
}

void Flip(Triangle& face) { std::swap(face[1], face[2]); }

// However many faces a file has the wrong way round, the mesh is the same.
TEST(CanonicalMeshTest, TurningFacesCannotMatter) {
  const DecodedMesh mesh = Torus(9, 11);
  const CanonicalMesh expected = Canonical(mesh);
  for (const uint32_t share : {1u, 9u, 10u, 11u, 19u, 20u}) {
    DecodedMesh turned = mesh;
    std::mt19937 random(share);
    uint64_t count = 0;
    for (Triangle& face : turned.faces)
      if (random() % 20 < share) {
        Flip(face);
        ++count;
      }
    const CanonicalMesh c = Canonical(turned);
    EXPECT_EQ(c.mesh.faces, expected.mesh.faces);
    EXPECT_EQ(c.face_map, expected.face_map);
    EXPECT_EQ(c.geometry_digest, expected.geometry_digest);
    EXPECT_EQ(c.report.flipped_faces, std::min(count, 198 - count));
  }
}

// Faces back to back, as programs write them that show one side alone. Either
// may be the one that is kept, so there is none to turn over.
TEST(CanonicalMeshTest, FacesBackToBackAreOne) {
  const DecodedMesh mesh = Torus(9, 11);
  const CanonicalMesh expected = Canonical(mesh);
  DecodedMesh doubled = mesh;
  for (Triangle face : mesh.faces) {
    Flip(face);
    doubled.faces.push_back(face);
  }
  CanonicalMesh c = Canonical(doubled);
  EXPECT_EQ(c.mesh.faces, expected.mesh.faces);
  EXPECT_EQ(c.geometry_digest, expected.geometry_digest);
  for (uint32_t f = 0; f < 198; ++f) {
    EXPECT_EQ(c.face_map[f], expected.face_map[f]);
    EXPECT_EQ(c.face_map[f + 198], expected.face_map[f]);
  }
  EXPECT_EQ(c.report.duplicate_faces, 198u);
  EXPECT_EQ(c.report.flipped_faces, 0u);
  // Of one that is there once, and of one that is there twice and no other way.
  doubled.faces.pop_back();
  Flip(doubled.faces[197]);
  doubled.faces[198] = doubled.faces[0];
  Flip(doubled.faces[0]);
  Flip(doubled.faces[198]);
  c = Canonical(doubled);
  EXPECT_EQ(c.geometry_digest, expected.geometry_digest);
  EXPECT_EQ(c.report.duplicate_faces, 197u);
  // Those two disagree with nothing else: the others have no direction.
  EXPECT_EQ(c.report.flipped_faces, 0u);
  Flip(doubled.faces[197]);
  EXPECT_EQ(Canonical(doubled).report.flipped_faces, 1u);
}

// It has no outside, yet is the same whichever way its faces are turned.
TEST(CanonicalMeshTest, TurningFacesOfAMoebiusStripCannotMatter) {
  const TriangleMesh moebius = Moebius(9);
  const DecodedMesh strip{moebius.positions, moebius.faces};
  const CanonicalMesh expected = Canonical(strip);
  EXPECT_FALSE(expected.report.orientable);
  for (uint32_t seed = 1; seed <= 5; ++seed) {
    std::mt19937 random(seed);
    DecodedMesh turned = strip;
    for (Triangle& face : turned.faces)
      if (random() % 2 == 0) Flip(face);
    const CanonicalMesh c = Canonical(turned);
    EXPECT_EQ(c.geometry_digest, expected.geometry_digest);
    EXPECT_EQ(c.report.flipped_faces, 0u);
  }
}

TEST(CanonicalMeshTest, DigestSeesGeometryAlone) {
  const DecodedMesh mesh = Torus(5, 6);
  const Digest digest = Canonical(mesh).geometry_digest;
  DecodedMesh moved = mesh;
  moved.positions(7, 1) = std::nextafter(moved.positions(7, 1), 100.0);
  EXPECT_NE(Canonical(moved).geometry_digest, digest);
  DecodedMesh flipped = mesh;
  std::swap(flipped.faces[3][0], flipped.faces[3][1]);
  EXPECT_EQ(Canonical(flipped).geometry_digest, digest);
  DecodedMesh open = mesh;
  open.faces.pop_back();
  EXPECT_NE(Canonical(open).geometry_digest, digest);
}

TEST(CanonicalMeshTest, MinusZeroIsZero) {
  const auto plus =
      Canonical(MeshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
  const auto minus = Canonical(MeshOf(
      {{-0.0, 0, 0}, {1, -0.0, -0.0}, {0, 1, 0}, {0, -0.0, 0}}, {{0, 1, 2}}));
  EXPECT_EQ(minus.geometry_digest, plus.geometry_digest);
  EXPECT_EQ(minus.report.welded_points, 1u);
  EXPECT_EQ(minus.report.unused_points, 1u);
  EXPECT_EQ(minus.point_map[3], minus.point_map[0]);
}

TEST(CanonicalMeshTest, PointsWithoutFacesHaveNoVertex) {
  const auto c = Canonical(MeshOf(
      {{5, 5, 5}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-5, 0, 0}}, {{1, 2, 3}}));
  EXPECT_EQ(c.report.vertices, 3u);
  EXPECT_EQ(c.report.unused_points, 2u);
  EXPECT_THAT(c.point_map, ElementsAre(kNoIndex, 0, 2, 1, kNoIndex));
}

TEST(CanonicalMeshTest, DegenerateFacesFollowANeighbour) {
  // Two triangles far apart; canonical faces 0 (near 0) and 1 (near 10).
  const DecodedMesh mesh = MeshOf({{0, 0, 0},
                                   {1, 0, 0},
                                   {0, 1, 0},
                                   {10, 0, 0},
                                   {11, 0, 0},
                                   {10, 1, 0},
                                   {9, 9, 9},
                                   {1, 5, 0},
                                   {-4, 0, 0}},
                                  {{3, 4, 5},
                                   {0, 1, 2},
                                   {4, 5, 5},    // on an edge of face 1
                                   {6, 3, 6},    // touches a corner of face 1
                                   {7, 7, 7},    // alone, nearer to face 0
                                   {6, 6, 6},    // alone, nearer to face 1
                                   {8, 8, 8}});  // before every vertex
  const auto c = Canonical(mesh);
  EXPECT_EQ(c.report.degenerate_faces, 5u);
  EXPECT_THAT(c.face_map, ElementsAre(1, 0, 1, 1, 0, 1, 0));
  EXPECT_EQ(c.point_map[6], kNoIndex);
}

TEST(CanonicalMeshTest, RejectsWhatHasNoSurface) {
  ExpectRejected(MeshOf({{0, 0, 0}}, {}), "no faces");
  ExpectRejected(MeshOf({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}),
                 "all 1 faces are degenerate");
  ExpectRejected(MeshOf({{1, 2, 3}, {2, 4, 6}, {3, 6, 9}}, {{0, 1, 2}}),
                 "the area of the mesh is zero");
  const DecodedMesh huge =
      MeshOf({{-1e308, 0, 0}, {1e308, 0, 0}, {0, 1e308, 0}}, {{0, 1, 2}});
  ExpectRejected(huge, "overflows");
  ExpectRejected(MeshOf({{0, 0, 0}, {1e200, 0, 0}, {0, 1e200, 0}}, {{0, 1, 2}}),
                 "overflows");
  ExpectRejected(
      MeshOf({{0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}}, {{0, 1, 2}}),
      "underflows");
  ExpectRejected(MeshOf({{0, 0, 0}, {1e300, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}),
                 "as good as zero");
}

TEST(CanonicalMeshTest, AreaAtEveryScale) {
  const double unit = Canonical(Torus(16, 16)).report.area;
  EXPECT_NEAR(unit, 4 * M_PI * M_PI * 3, 0.05 * unit);
  for (double scale : {1e-100, 1e-20, 1e20, 1e100}) {
    DecodedMesh mesh = Torus(16, 16);
    mesh.positions *= scale;
    const double area = Canonical(mesh).report.area;
    EXPECT_NEAR(area / scale / scale, unit, 1e-12 * unit) << scale;
  }
}

}  // namespace
}  // namespace marrow
