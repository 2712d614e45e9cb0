#include "tests/testing/hostile_meshes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>

#include "tests/testing/hostile_cases.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// --- Numbers (46 to 55) ---

TriangleMesh WithCoordinate(double value) {
  TriangleMesh mesh = Icosphere(2);
  mesh.positions(7, 1) = value;
  return mesh;
}

TriangleMesh AllAt(double x) {
  TriangleMesh mesh = Icosphere(2);
  mesh.positions.setConstant(x);
  return mesh;
}

// The smallest floats that there are: the points of a cube, 1e-45 apart.
TriangleMesh Denormals() {
  TriangleMesh mesh = CubesSurface({{0, 0, 0}}, 4);
  mesh.positions *= 4 * std::numeric_limits<float>::denorm_min();
  return mesh;
}

// One half of a sphere is 1e60 times the other.
TriangleMesh MixedScales() {
  TriangleMesh mesh = Icosphere(3);
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
    mesh.positions.row(v) *= mesh.positions(v, 2) >= 0 ? 1e30 : 1e-30;
  return mesh;
}

TriangleMesh Moved(TriangleMesh mesh, double by) {
  mesh.positions.array() += by;
  return mesh;
}

TriangleMesh Collinear() {
  TriangleMesh mesh = Grid(20, 20);
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
    mesh.positions.row(v).setConstant(v);
  return mesh;
}

// --- Faces without area, needles and caps (56 to 60) ---

TriangleMesh OneFace(const Triangle& face) {
  TriangleMesh mesh = SingleTriangle();
  mesh.faces = {face};
  return mesh;
}

// A flap without area hangs on the first edge of every face.
TriangleMesh WithFlatFlaps(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  const uint32_t n = mesh.NumVertices();
  result.positions.conservativeResize(n + mesh.NumFaces(), 3);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const auto [a, b, c] = mesh.faces[f];
    result.positions.row(n + f) =
        0.5 * (mesh.positions.row(a) + mesh.positions.row(b));
    result.faces.push_back({a, b, n + f});
  }
  return result;
}

// Rings about the origin, each of half the radius of the one around it.
TriangleMesh HalvingRings(uint32_t rings, uint32_t around) {
  Builder builder;
  for (uint32_t i = 0; i < rings; ++i)
    for (uint32_t j = 0; j < around; ++j)
      builder.Add(std::ldexp(std::cos(2 * pi * j / around), -int(i)),
                  std::ldexp(std::sin(2 * pi * j / around), -int(i)), 0);
  for (uint32_t i = 0; i + 1 < rings; ++i)
    for (uint32_t j = 0; j < around; ++j) {
      const uint32_t k = (j + 1) % around;
      builder.Square(i * around + j, i * around + k, (i + 1) * around + k,
                     (i + 1) * around + j);
    }
  return builder.Build();
}

// A strip whose steps shrink along it, while its width stays: needles across;
// beside it one whose width shrinks: caps.
TriangleMesh NeedlesAndCaps() {
  Builder builder;
  for (int i = 0; i <= 40; ++i) {
    builder.Add(1 + std::ldexp(1.0, -i), -1, 0);
    builder.Add(1 + std::ldexp(1.0, -i), 0, 0);
    builder.Add(1 + std::ldexp(1.0, -i), std::ldexp(1.0, -i), 0);
  }
  for (uint32_t i = 0; i < 40; ++i) {
    builder.Square(3 * i, 3 * i + 1, 3 * i + 4, 3 * i + 3);
    builder.Square(3 * i + 1, 3 * i + 2, 3 * i + 5, 3 * i + 4);
  }
  return builder.Build();
}

// --- Duplicates, orientation, what is not a manifold (61 to 69) ---

TriangleMesh WithDuplicates(uint32_t count) {
  TriangleMesh mesh = LimbCross(2);
  for (uint32_t i = 0; i < count; ++i) {
    const Triangle face = mesh.faces[i % 7];
    mesh.faces.push_back({face[i % 3], face[(i + 1) % 3], face[(i + 2) % 3]});
  }
  return mesh;
}

TriangleMesh EveryFaceTwice() {
  TriangleMesh mesh = LimbCross(2);
  for (uint32_t f = 0, m = mesh.NumFaces(); f < m; ++f) {
    const auto [a, b, c] = mesh.faces[f];
    mesh.faces.push_back({a, c, b});
  }
  return mesh;
}

TriangleMesh RandomOrientation() {
  TriangleMesh mesh = LimbCross(2);
  std::mt19937 random(63);
  for (Triangle& face : mesh.faces)
    if (random() % 2 == 0) std::swap(face[0], face[1]);
  return mesh;
}

// Cones that share their tip, on the directions of a Fibonacci sphere.
TriangleMesh Cones(uint32_t count) {
  constexpr uint32_t kAround = 6;
  Builder builder;
  const uint32_t tip = builder.Add(0, 0, 0);
  for (uint32_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count;
    const double turn = i * pi * (3 - std::sqrt(5.0));
    const double w = std::sqrt(1 - z * z);
    const Vector3d axis(w * std::cos(turn), w * std::sin(turn), z);
    const Vector3d u = axis.unitOrthogonal();
    const Vector3d v = axis.cross(u);
    const double radius = 1 / std::sqrt(count);
    uint32_t first = 0;
    for (uint32_t j = 0; j < kAround; ++j) {
      const double angle = 2 * pi * j / kAround;
      const Vector3d p =
          axis + radius * (std::cos(angle) * u + std::sin(angle) * v);
      const uint32_t id = builder.Add(p[0], p[1], p[2]);
      if (j == 0) first = id;
    }
    for (uint32_t j = 0; j < kAround; ++j)
      builder.Face(tip, first + j, first + (j + 1) % kAround);
  }
  return builder.Build();
}

// Closed fans between each of the heights and one rim.
TriangleMesh Fans(uint32_t around, const std::vector<double>& heights) {
  Builder builder;
  for (uint32_t j = 0; j < around; ++j)
    builder.Add(std::cos(2 * pi * j / around), std::sin(2 * pi * j / around),
                0);
  for (double height : heights) {
    const uint32_t tip = builder.Add(0, 0, height);
    for (uint32_t j = 0; j < around; ++j)
      builder.Face(tip, j, (j + 1) % around);
  }
  return builder.Build();
}

// --- Many pieces (70 to 73) ---

TriangleMesh WithIsolatedVertices(TriangleMesh mesh, uint32_t count) {
  const uint32_t n = mesh.NumVertices();
  mesh.positions.conservativeResize(n + count, 3);
  for (uint32_t i = 0; i < count; ++i)
    mesh.positions.row(n + i) << 3 + 1e-3 * (i % 100), 1e-3 * (i / 100 % 100),
        1e-3 * (i / 10000);
  return mesh;
}

// Copies on a cubic lattice, as wide apart as they are.
TriangleMesh Copies(const TriangleMesh& part, uint32_t count) {
  const uint32_t side = static_cast<uint32_t>(std::ceil(std::cbrt(count)));
  const uint32_t n = part.NumVertices();
  const double step = 2 * (part.positions.colwise().maxCoeff() -
                           part.positions.colwise().minCoeff())
                              .maxCoeff();
  TriangleMesh mesh;
  mesh.positions.resize(size_t{n} * count, 3);
  mesh.faces.reserve(part.faces.size() * count);
  for (uint32_t i = 0; i < count; ++i) {
    const Eigen::RowVector3d shift(i % side, i / side % side, i / side / side);
    mesh.positions.middleRows(size_t{n} * i, n) =
        part.positions.rowwise() + step * shift;
    for (const auto& [a, b, c] : part.faces)
      mesh.faces.push_back({n * i + a, n * i + b, n * i + c});
  }
  return mesh;
}

void AddNumbers(Cases& cases) {
  cases.insert(
      cases.end(),
      {{"c46_one_nan", [] { return WithCoordinate(kNaN); }},
       {"c47_infinity", [] { return WithCoordinate(kInfinity); }},
       {"c47_minus_infinity", [] { return WithCoordinate(-kInfinity); }},
       {"c48_all_minus_zero", [] { return AllAt(-0.0); }},
       {"c48_denormals", Denormals},
       {"c49_1e30", [] { return Scaled(LimbCross(2), 1e29); }},
       {"c50_largest_floats",
        [] {
          return Scaled(CubesSurface({{0, 0, 0}}, 8), 3.4e38);
        }},
       {"c50_plus_and_minus_largest_floats",
        [] { return Scaled(Icosphere(3), 3.4e38); }},
       {"c51_box_1e_30", [] { return Scaled(LimbCross(2), 1e-31); }},
       {"c52_1e30_and_1e_30", MixedScales},
       {"c53_offset_1e7_in_floats",
        [] { return Rounded(Moved(LimbCross(2), 1e7)); }},
       {"c53_offset_1e7_in_doubles", [] { return Moved(LimbCross(2), 1e7); }},
       {"c54_identical_points", [] { return AllAt(2.5); }},
       {"c55_collinear", Collinear}});
}

void AddThinFaces(Cases& cases) {
  cases.insert(cases.end(),
               {{"c56_single_triangle",
                 [] {
                   return OneFace({0, 1, 2});
                 }},
                {"c57_single_degenerate",
                 [] {
                   return OneFace({0, 0, 0});
                 }},
                {"c58_every_second_face_flat",
                 [] { return WithFlatFlaps(LimbCross(2)); }},
                {"c59_slivers_1e_12",
                 [] { return WithSlivers(LimbCross(2), 3, 1e-12); }},
                {"c60_halving_rings", [] { return HalvingRings(41, 12); }},
                {"c60_needles_and_caps", NeedlesAndCaps}});
}

void AddTangles(bool full, Cases& cases) {
  const uint32_t around = full ? 1'000'000 : 10'000;
  cases.insert(cases.end(),
               {{"c61_duplicate_faces", [] { return WithDuplicates(100'000); }},
                {"c62_every_face_twice", EveryFaceTwice},
                {"c63_random_orientation", RandomOrientation},
                {"c64_edge_in_3_faces", [] { return Book(3, 20); }},
                {"c65_book", [=] { return Book(full ? 100'000 : 2'000, 1); }},
                {"c66_bowtie", [] { return Bowtie(8); }},
                {"c67_cones", [] { return Cones(1'000); }},
                {"c68_fan", [=] { return Fans(around, {0.5}); }},
                {"c69_bipyramid", [=] {
                   return Fans(around / 2, {1, -1});
                 }}});
}

void AddManyPieces(bool full, Cases& cases) {
  const uint32_t bodies = full ? 100'000 : 1'000;
  cases.insert(
      cases.end(),
      {{"c70_isolated_vertices",
        [=] {
          return full ? WithIsolatedVertices(LimbCross(12), 100'000)
                      : WithIsolatedVertices(LimbCross(2), 2'500);
        }},
       // More than three a face: Draco's sequential files cannot hold them.
       {"c70_too_many_isolated_vertices",
        [] { return WithIsolatedVertices(LimbCross(2), 100'000); }},
       {"c71_tetrahedra", [=] { return Copies(Tetrahedron(), bodies); }},
       {"c72_triangles",
        [=] { return Copies(SingleTriangle(), full ? 1'000'000 : 3'000); }},
       // As many as the default limit lets in.
       {"c72_most_triangles",
        [=] { return Copies(SingleTriangle(), full ? 666'666 : 3'000); }},
       {"c73_fewer_vertices_than_pairs", Tetrahedron},
       {"c73_fewer_pairs_than_components",
        [] { return Copies(Tetrahedron(), 300); }}});
}

}  // namespace

std::vector<HostileMesh> HostileMeshes(HostileSize size) {
  const bool full = size == HostileSize::kFull;
  Cases cases;
  AddNumbers(cases);
  AddThinFaces(cases);
  AddTangles(full, cases);
  AddManyPieces(full, cases);
  AddTopology(full, cases);
  AddSpectra(full, cases);
  return cases;
}

}  // namespace marrow
