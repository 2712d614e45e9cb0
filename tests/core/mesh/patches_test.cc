#include "core/mesh/patches.h"

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// Without those of its faces.
TriangleMesh Without(TriangleMesh mesh, const std::set<uint32_t>& missing) {
  std::vector<Triangle> kept;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (!missing.contains(f)) kept.push_back(mesh.faces[f]);
  mesh.faces = kept;
  return mesh;
}

std::vector<Triangle> PatchesOf(const TriangleMesh& mesh) {
  return PatchHoles(mesh, CancelToken()).value();
}

std::set<uint32_t> FacesOf(const TriangleMesh& mesh, uint32_t v) {
  std::set<uint32_t> faces;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    for (uint32_t corner : mesh.faces[f])
      if (corner == v) faces.insert(f);
  return faces;
}

// A card on a creature has an outline of its own.
TEST(PatchHolesTest, WhatHangsOnAVertexIsNotClosed) {
  TriangleMesh mesh = Icosphere(2);
  const uint32_t n = mesh.NumVertices();
  mesh.positions.conservativeResize(n + 3, 3);
  mesh.positions.bottomRows(3) << 2, 0, 0, 2, 0.1, 0, 2, 0.1, 0.1;
  mesh.faces.push_back({0, n, n + 1});
  mesh.faces.push_back({0, n + 1, n + 2});
  EXPECT_TRUE(PatchesOf(CanonicalOf(mesh).mesh).empty());
}

TEST(PatchHolesTest, AFaceIsPutBackAsItWas) {
  const TriangleMesh mesh = CanonicalOf(Icosphere(2)).mesh;
  EXPECT_TRUE(PatchesOf(mesh).empty());
  EXPECT_EQ(PatchesOf(Without(mesh, {17})),
            std::vector<Triangle>{mesh.faces[17]});
}

// The gaps between them are told apart by their order around the vertex.
TEST(PatchHolesTest, HolesThatTouchAreHolesOfTheirOwn) {
  const TriangleMesh mesh = CanonicalOf(Icosphere(2)).mesh;
  const std::set<uint32_t> around = FacesOf(mesh, 40);
  std::set<uint32_t> missing;
  std::vector<Triangle> expected;
  for (uint32_t f : around) {
    const auto& face = mesh.faces[f];
    const bool is_beside = std::any_of(
        expected.begin(), expected.end(), [&](const Triangle& other) {
          return std::count_if(face.begin(), face.end(), [&](uint32_t v) {
                   return std::ranges::count(other, v) > 0;
                 }) == 2;
        });
    if (is_beside) continue;
    missing.insert(f);
    expected.push_back(face);
  }
  ASSERT_EQ(missing.size(), around.size() / 2);
  EXPECT_EQ(PatchesOf(Without(mesh, missing)), expected);
}

TEST(PatchHolesTest, AFanIsFilledWithoutItsVertex) {
  const TriangleMesh mesh = CanonicalOf(Icosphere(4)).mesh;
  const std::set<uint32_t> fan = FacesOf(mesh, 100);
  const std::vector<Triangle> patches = PatchesOf(Without(mesh, fan));
  EXPECT_EQ(patches.size(), fan.size() - 2);
  for (const Triangle& face : patches)
    EXPECT_EQ(std::ranges::count(face, 100u), 0);
}

TEST(PatchHolesTest, NeitherOutlinesNorOpeningsAreHoles) {
  EXPECT_TRUE(PatchesOf(SingleTriangle()).empty());
  EXPECT_TRUE(PatchesOf(Grid(1, 1)).empty());
  EXPECT_TRUE(PatchesOf(Grid(20, 20)).empty());
  EXPECT_TRUE(PatchesOf(Moebius(20)).empty());
}

// A third of the faces missing at random leaves next to nothing open.
TEST(PatchHolesTest, ASieveIsASurfaceAgain) {
  const TriangleMesh mesh = CanonicalOf(Icosphere(5)).mesh;
  std::mt19937 random(1);
  std::set<uint32_t> missing;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (random() % 3 == 0) missing.insert(f);
  TriangleMesh sieve = Without(mesh, missing);
  const size_t open = CanonicalOf(sieve).report.boundary_edges;
  const std::vector<Triangle> patches = PatchesOf(sieve);
  sieve.faces.insert(sieve.faces.end(), patches.begin(), patches.end());
  EXPECT_LT(CanonicalOf(sieve).report.boundary_edges, open / 10);
}

}  // namespace
}  // namespace marrow
