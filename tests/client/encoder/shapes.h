// Meshes for the tests of the encoder.
#ifndef MARROW_TESTS_CLIENT_ENCODER_SHAPES_H_
#define MARROW_TESTS_CLIENT_ENCODER_SHAPES_H_

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "client/polygon_mesh.h"

namespace marrow {

using Corners3 = std::array<uint32_t, 3>;
using Corners4 = std::array<uint32_t, 4>;

inline constexpr uint32_t kAround = 9;
inline constexpr uint32_t kAlong = 7;

// A torus of 63 quads, its faces in a shuffled order so that no encoder keeps
// it by luck, as quads or cut into triangles.
inline PolygonMesh Torus(bool quads) {
  PolygonMesh mesh;
  for (uint32_t i = 0; i < kAround; ++i) {
    for (uint32_t j = 0; j < kAlong; ++j) {
      const double u = 2 * M_PI * i / kAround;
      const double v = 2 * M_PI * j / kAlong;
      const double radius = 3 + std::cos(v);
      mesh.positions.push_back({static_cast<float>(radius * std::cos(u)),
                                static_cast<float>(radius * std::sin(u)),
                                static_cast<float>(std::sin(v))});
    }
  }
  constexpr uint32_t kCells = kAround * kAlong;
  for (uint32_t k = 0; k < kCells; ++k) {
    const uint32_t cell = k * 20 % kCells;  // 20 and 63 share no divisor
    const uint32_t i = cell / kAlong;
    const uint32_t j = cell % kAlong;
    const auto at = [](uint32_t a, uint32_t b) {
      return a % kAround * kAlong + b % kAlong;
    };
    const Corners4 quad = {at(i, j), at(i + 1, j), at(i + 1, j + 1),
                           at(i, j + 1)};
    if (quads) {
      mesh.AddFace(quad);
    } else {
      mesh.AddFace(Corners3{quad[0], quad[1], quad[2]});
      mesh.AddFace(Corners3{quad[0], quad[2], quad[3]});
    }
  }
  return mesh;
}

// A torus with a pentagon, a concave quad and a fan-proof hexagon beside it.
inline PolygonMesh Polygons() {
  PolygonMesh mesh = Torus(true);
  const auto add = [&mesh](const std::vector<std::array<double, 3>>& points) {
    std::vector<uint32_t> corners;
    for (const auto& point : points) {
      corners.push_back(static_cast<uint32_t>(mesh.NumVertices()));
      mesh.positions.push_back(point);
    }
    mesh.AddFace(corners);
  };
  add({{10, 0, 0}, {11, 0, 0}, {12, 1, 0}, {11, 2, 0}, {10, 2, 0}});
  add({{20, 0, 0}, {24, 0, 0}, {21, 1, 0}, {20, 4, 0}});
  add({{32, 0, 0}, {32, 1, 0}, {31, 1, 0}, {31, 2, 0}, {30, 2, 0}, {30, 0, 0}});
  return mesh;
}

// Five fins on one edge, two cones that touch at a vertex, and a strip that is
// glued to itself the wrong way round.
inline PolygonMesh NonManifold() {
  PolygonMesh mesh = Torus(false);
  const uint32_t base = static_cast<uint32_t>(mesh.NumVertices());
  mesh.positions.push_back({0, 0, 10});
  mesh.positions.push_back({0, 0, 12});
  for (int i = 0; i < 5; ++i) {
    mesh.positions.push_back(
        {static_cast<float>(std::cos(i)), static_cast<float>(std::sin(i)), 11});
    const uint32_t tip = base + 2 + static_cast<uint32_t>(i);
    mesh.AddFace(i % 2 == 0 ? Corners3{base, base + 1, tip}
                            : Corners3{base + 1, base, tip});
  }
  const uint32_t apex = static_cast<uint32_t>(mesh.NumVertices());
  mesh.positions.push_back({0, 0, 20});
  for (int side : {-1, 1}) {
    const uint32_t ring = static_cast<uint32_t>(mesh.NumVertices());
    for (int i = 0; i < 4; ++i) {
      mesh.positions.push_back({static_cast<float>(std::cos(1.5 * i)),
                                static_cast<float>(std::sin(1.5 * i)),
                                static_cast<float>(20 + side)});
    }
    for (uint32_t i = 0; i < 4; ++i) {
      mesh.AddFace(Corners3{apex, ring + i, ring + (i + 1) % 4});
    }
  }
  mesh.AddFace(Corners3{apex, base, base + 1});
  return mesh;
}

// Faces that repeat others: the same corners, rotated, turned over, and through
// other vertices at the same positions.
inline PolygonMesh Duplicates() {
  PolygonMesh mesh = Torus(false);
  for (uint32_t f = 0; f < 30; f += 3) {
    const auto face = mesh.Face(f);
    Corners3 c = {face[0], face[1], face[2]};
    if (f % 2 == 0) mesh.AddFace(c);
    mesh.AddFace(Corners3{c[1], c[2], c[0]});
    mesh.AddFace(Corners3{c[2], c[1], c[0]});
    if (f > 15) continue;
    for (uint32_t& v : c) {
      mesh.positions.push_back(mesh.positions[v]);
      v = static_cast<uint32_t>(mesh.NumVertices() - 1);
    }
    mesh.AddFace(c);
  }
  return mesh;
}

// The faces of a torus, each of a size and on its own: none shares a vertex or
// a position with another.
inline PolygonMesh Apart() {
  const PolygonMesh torus = Torus(false);
  PolygonMesh mesh;
  for (uint32_t f = 0; f < torus.NumFaces(); ++f) {
    const uint32_t first = static_cast<uint32_t>(mesh.NumVertices());
    for (const uint32_t v : torus.Face(f)) {
      auto [x, y, z] = torus.positions[v];
      const double s = 1 - 0.001 * (f + 1);
      mesh.positions.push_back({static_cast<float>(s * x),
                                static_cast<float>(s * y),
                                static_cast<float>(s * z)});
    }
    mesh.AddFace(Corners3{first, first + 1, first + 2});
  }
  return mesh;
}

// Faces with repeated corners, with fewer than three, with three corners at two
// positions, and of no area, strewn among the others.
inline PolygonMesh Degenerate() {
  PolygonMesh mesh;
  const PolygonMesh torus = Torus(false);
  mesh.positions = torus.positions;
  mesh.positions.push_back(mesh.positions[5]);
  const uint32_t twin = static_cast<uint32_t>(mesh.NumVertices() - 1);
  mesh.positions.push_back({1, 1, 1});  // used by a face of two corners alone
  for (uint32_t f = 0; f < torus.NumFaces(); ++f) {
    if (f == 10) mesh.AddFace(Corners3{4, 4, 5});
    if (f == 20) mesh.AddFace(Corners3{7, 7, 7});
    if (f == 30) mesh.AddFace(std::array<uint32_t, 2>{3, 4});
    if (f == 40) mesh.AddFace({});
    if (f == 50) mesh.AddFace(Corners3{5, twin, 6});
    if (f == 60) mesh.AddFace(std::array<uint32_t, 2>{twin + 1, twin + 1});
    if (f == 70) mesh.AddFace(Corners4{8, 8, 9, 9});
    mesh.AddFace(torus.Face(f));
  }
  return mesh;
}

// Vertices that no face uses, first, last and in between.
inline PolygonMesh Isolated() {
  const PolygonMesh torus = Torus(false);
  PolygonMesh mesh;
  std::vector<uint32_t> moved;
  mesh.positions.push_back({50, 0, 0});
  for (uint32_t v = 0; v < torus.NumVertices(); ++v) {
    if (v % 10 == 3) mesh.positions.push_back({60, static_cast<float>(v), 0});
    moved.push_back(static_cast<uint32_t>(mesh.NumVertices()));
    mesh.positions.push_back(torus.positions[v]);
  }
  mesh.positions.push_back({70, 0, 0});
  mesh.positions.push_back(torus.positions[0]);  // unused, at a used place
  for (uint32_t f = 0; f < torus.NumFaces(); ++f) {
    const auto face = torus.Face(f);
    mesh.AddFace(Corners3{moved[face[0]], moved[face[1]], moved[face[2]]});
  }
  return mesh;
}

// An atlas cut along the plane y = 0, where one side's u begins again.
inline void AddUvSeam(PolygonMesh* mesh) {
  for (size_t f = 0; f < mesh->NumFaces(); ++f) {
    double y = 0;
    for (const uint32_t v : mesh->Face(f)) y += mesh->positions[v][1];
    for (const uint32_t v : mesh->Face(f)) {
      const auto& p = mesh->positions[v];
      mesh->corner_uvs.push_back({static_cast<float>(p[0] + (y > 0 ? 100 : 0)),
                                  static_cast<float>(p[2])});
    }
  }
}

// Flat shading on one side: every face has a normal of its own.
inline void AddNormalSeams(PolygonMesh* mesh) {
  for (size_t f = 0; f < mesh->NumFaces(); ++f) {
    for (const uint32_t v : mesh->Face(f)) {
      const float smooth = static_cast<float>(mesh->positions[v][0]);
      const float flat = static_cast<float>(f);
      mesh->corner_normals.push_back({f % 2 == 0 ? smooth : flat, 0, 1});
    }
  }
}

}  // namespace marrow

#endif  // MARROW_TESTS_CLIENT_ENCODER_SHAPES_H_
