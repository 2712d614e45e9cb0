// Hostile meshes 74 to 82: odd topology, odd spectra.
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

// --- Topology (74 to 78) ---

TriangleMesh MoebiusStrip(uint32_t around, uint32_t across) {
  Builder builder;
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j <= across; ++j) {
      const double u = 2 * pi * i / around, w = double(j) / across - 0.5;
      const double r = 2 + w * std::cos(u / 2);
      builder.Add(r * std::cos(u), r * std::sin(u), w * std::sin(u / 2));
    }
  auto at = [&](uint32_t i, uint32_t j) {
    return i < around ? i * (across + 1) + j : across - j;
  };
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < across; ++j)
      builder.Square(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return builder.Build();
}

// The figure of eight, turned half while it goes around.
TriangleMesh KleinBottle(uint32_t around, uint32_t across) {
  Builder builder;
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < across; ++j) {
      const double u = 2 * pi * i / around, v = 2 * pi * (j + 0.5) / across;
      const double r =
          3 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
      builder.Add(
          r * std::cos(u), r * std::sin(u),
          std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v));
    }
  auto at = [&](uint32_t i, uint32_t j) {
    j %= across;
    return i < around ? i * across + j : across - 1 - j;
  };
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < across; ++j)
      builder.Square(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return builder.Build();
}

// A plate with columns by rows square tunnels through it: that is its genus.
TriangleMesh Plate(int columns, int rows) {
  std::set<std::array<int, 3>> cubes;
  for (int x = 0; x <= 2 * columns; ++x)
    for (int y = 0; y <= 2 * rows; ++y)
      if (x % 2 == 0 || y % 2 == 0) cubes.insert({x, y, 0});
  return CubesSurface(cubes, 1);
}

// A flat plate with side by side square holes.
TriangleMesh Sieve(uint32_t side) {
  const uint32_t squares = 2 * side + 1;
  TriangleMesh mesh = Grid(squares, squares);
  std::vector<Triangle> kept;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const uint32_t x = f / 2 / squares, y = f / 2 % squares;
    if (x % 2 == 0 || y % 2 == 0) kept.push_back(mesh.faces[f]);
  }
  mesh.faces = std::move(kept);
  return mesh;
}

TriangleMesh Annulus(uint32_t rings, uint32_t hole) {
  TriangleMesh mesh = Disk(rings);
  const uint32_t inner = 1 + 3 * hole * (hole - 1);
  std::erase_if(mesh.faces, [&](const Triangle& face) {
    return face[0] < inner || face[1] < inner || face[2] < inner;
  });
  return mesh;
}

TriangleMesh TwoSheets(double gap) {
  const TriangleMesh sheet = Grid(30, 20);
  TriangleMesh mesh = sheet;
  const uint32_t n = sheet.NumVertices();
  mesh.positions.conservativeResize(2 * n, 3);
  mesh.positions.bottomRows(n) = sheet.positions;
  mesh.positions.bottomRows(n).col(2).setConstant(gap);
  for (const auto& [a, b, c] : sheet.faces)
    mesh.faces.push_back({n + a, n + b, n + c});
  return mesh;
}

// --- Spectra (79 to 82) ---

// Squeezes the neck's ring in the middle to the given radius.
TriangleMesh PinchedDumbbell(double radius) {
  TriangleMesh mesh = Dumbbell(0.8, 24);
  double least = kInfinity;
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
    least = std::min(least, std::abs(mesh.positions(v, 0)));
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
    if (std::abs(mesh.positions(v, 0)) < least + 1e-9)
      mesh.positions.row(v).tail<2>() *=
          radius / mesh.positions.row(v).tail<2>().norm();
  return mesh;
}

// The cell at place i of Hilbert's curve through 2^order by 2^order cells.
std::array<uint32_t, 2> HilbertCell(uint32_t order, uint32_t i) {
  uint32_t x = 0, y = 0;
  for (uint32_t side = 1; side < 1u << order; side *= 2, i /= 4) {
    const uint32_t rx = i / 2 & 1, ry = (i ^ rx) & 1;
    if (ry == 0) {
      if (rx == 1) {
        x = side - 1 - x;
        y = side - 1 - y;
      }
      std::swap(x, y);
    }
    x += side * rx;
    y += side * ry;
  }
  return {x, y};
}

// A strip of squares along Hilbert's curve, with slits between its turns: a
// small extent and a diameter of 4^order.
TriangleMesh HilbertStrip(uint32_t order) {
  Builder builder;
  // Corners are shared by cells that follow each other, and by no others.
  std::map<std::array<uint32_t, 2>, uint32_t> before, now;
  for (uint32_t i = 0; i < 1u << 2 * order; ++i) {
    const auto [x, y] = HilbertCell(order, i);
    now.clear();
    auto corner = [&](uint32_t u, uint32_t w) {
      const auto known = before.find({u, w});
      const uint32_t id = known != before.end()
                              ? known->second
                              : builder.Add(u, w, 1e-3 * i / (1u << order));
      now[{u, w}] = id;
      return id;
    };
    const uint32_t a = corner(x, y), b = corner(x + 1, y);
    const uint32_t c = corner(x + 1, y + 1), d = corner(x, y + 1);
    builder.Square(a, b, c, d);
    std::swap(before, now);
  }
  return builder.Build();
}

TriangleMesh MengerSponge(uint32_t order) {
  int side = 1;
  for (uint32_t i = 0; i < order; ++i) side *= 3;
  auto is_solid = [&](int x, int y, int z) {
    for (; x > 0 || y > 0 || z > 0; x /= 3, y /= 3, z /= 3)
      if ((x % 3 == 1) + (y % 3 == 1) + (z % 3 == 1) >= 2) return false;
    return true;
  };
  std::set<std::array<int, 3>> cubes;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z)
        if (is_solid(x, y, z)) cubes.insert({x, y, z});
  return CubesSurface(cubes, 1);
}

// A strip of triangles that alternate, with a tooth on each tenth.
TriangleMesh Comb(uint32_t triangles) {
  Builder builder;
  const uint32_t length = triangles / 11 * 10;
  for (uint32_t i = 0; i < length + 2; ++i) builder.Add(0.5 * i, i % 2, 0);
  for (uint32_t i = 0; i < length; ++i) {
    builder.Face(i, i + 1, i + 2);
    if (i % 10 == 0) builder.Face(i, i + 2, builder.Add(0.5 * i + 0.5, -2, 0));
  }
  return builder.Build();
}

}  // namespace

void AddTopology(bool full, Cases& cases) {
  cases.insert(cases.end(),
               {{"c74_moebius_strip", [] { return MoebiusStrip(60, 6); }},
                {"c74_klein_bottle", [] { return KleinBottle(50, 20); }},
                {"c75_genus_0", [] { return LimbCross(2); }},
                {"c75_genus_1", [] { return Torus(2, 0.7, 40, 14); }},
                {"c75_genus_2", [] { return Plate(2, 1); }},
                {"c75_genus_100", [] { return Plate(10, 10); }},
                {"c75_genus_1000", [] { return Plate(40, 25); }},
                {"c76_spindle_torus", [] { return Torus(0.4, 1, 40, 30); }},
                {"c77_sheets_1e_9_apart", [] { return TwoSheets(1e-9); }},
                {"c78_disk", [] { return Disk(20); }},
                {"c78_annulus", [] { return Annulus(20, 12); }},
                {"c78_holes", [=] { return Sieve(full ? 100 : 20); }}});
}

void AddSpectra(bool full, Cases& cases) {
  cases.insert(
      cases.end(),
      {{"c79_icosphere", [] { return Icosphere(4); }},
       {"c79_cube",
        [] {
          return CubesSurface({{0, 0, 0}}, 16);
        }},
       {"c80_neck_1e_6", [] { return PinchedDumbbell(1e-6); }},
       {"c81_hilbert_strip", [=] { return HilbertStrip(full ? 9 : 6); }},
       {"c81_menger_sponge", [=] { return MengerSponge(full ? 4 : 2); }},
       {"c82_comb", [=] { return Comb(full ? 1'000'000 : 10'000); }}});
}

}  // namespace marrow
