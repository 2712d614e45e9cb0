#include "core/mesh/mesh_report.h"

#include <array>
#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "tests/core/mesh/draco_fixture.h"

namespace marrow {
namespace {

TriangleMesh MeshOf(const std::vector<std::array<double, 3>>& points,
                    std::vector<Triangle> faces) {
  TriangleMesh mesh;
  mesh.positions.resize(points.size(), 3);
  for (size_t p = 0; p < points.size(); ++p) {
    mesh.positions.row(p) << points[p][0], points[p][1], points[p][2];
  }
  mesh.faces = std::move(faces);
  return mesh;
}

// Two rows of n points, joined to a band; with a twist where it closes, a
// Moebius strip.
TriangleMesh Band(uint32_t n, bool twisted) {
  TriangleMesh mesh;
  mesh.positions.resize(2 * n, 3);
  for (uint32_t i = 0; i < n; ++i) {
    const double u = 2 * M_PI * i / n, v = twisted ? u / 2 : 0.3;
    for (int side : {0, 1}) {
      const double s = side ? 0.4 : -0.4;
      const double r = 2 + s * std::cos(v);
      mesh.positions.row(2 * i + side) << r * std::cos(u), r * std::sin(u),
          s * std::sin(v);
    }
    const bool swap = twisted && i + 1 == n;
    const uint32_t next = 2 * ((i + 1) % n);
    const uint32_t a = next + (swap ? 1 : 0), b = next + (swap ? 0 : 1);
    mesh.faces.push_back({2 * i, a, 2 * i + 1});
    mesh.faces.push_back({2 * i + 1, a, b});
  }
  return mesh;
}

TEST(MeshReportTest, ClosedTorus) {
  const DecodedMesh torus = Torus(8, 9);
  const MeshReport report = ReportOn({torus.positions, torus.faces});
  EXPECT_EQ(report.vertices, 72u);
  EXPECT_EQ(report.faces, 144u);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.boundary_edges, 0u);
  EXPECT_EQ(report.boundary_loops, 0u);
  EXPECT_EQ(report.nonmanifold_edges, 0u);
  EXPECT_EQ(report.nonmanifold_vertices, 0u);
  EXPECT_EQ(report.euler_characteristic, 0);
  EXPECT_EQ(report.zero_area_faces, 0u);
  EXPECT_DOUBLE_EQ(report.box_max.x(), 4);
  EXPECT_DOUBLE_EQ(report.box_min.x(), -4);
}

TEST(MeshReportTest, BoundaryLoops) {
  const MeshReport annulus = ReportOn(Band(20, false));
  EXPECT_EQ(annulus.boundary_edges, 40u);
  EXPECT_EQ(annulus.boundary_loops, 2u);
  EXPECT_EQ(annulus.euler_characteristic, 0);
  const MeshReport moebius = ReportOn(Band(20, true));
  EXPECT_EQ(moebius.boundary_edges, 40u);
  EXPECT_EQ(moebius.boundary_loops, 1u);
  EXPECT_EQ(moebius.euler_characteristic, 0);
}

TEST(MeshReportTest, ThreePagesAndABowtie) {
  const MeshReport book =
      ReportOn(MeshOf({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                      {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}));
  EXPECT_EQ(book.nonmanifold_edges, 1u);
  EXPECT_EQ(book.nonmanifold_vertices, 0u);
  EXPECT_EQ(book.boundary_edges, 6u);
  EXPECT_EQ(book.components, 1u);
  EXPECT_DOUBLE_EQ(book.area, 1.5);
  const MeshReport bowtie =
      ReportOn(MeshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}},
                      {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_EQ(bowtie.nonmanifold_edges, 0u);
  EXPECT_EQ(bowtie.nonmanifold_vertices, 1u);
  EXPECT_EQ(bowtie.components, 1u);
  EXPECT_EQ(bowtie.boundary_loops, 1u);
}

TEST(MeshReportTest, CountsComponents) {
  TriangleMesh mesh;
  const uint32_t pieces = 1000;
  mesh.positions.resize(3 * pieces, 3);
  for (uint32_t i = 0; i < pieces; ++i) {
    mesh.positions.middleRows<3>(3 * i) << i, 0, 0, i, 1, 0, i, 0, 1;
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const MeshReport report = ReportOn(mesh);
  EXPECT_EQ(report.components, pieces);
  EXPECT_EQ(report.boundary_loops, pieces);
  EXPECT_EQ(report.euler_characteristic, pieces);
}

TEST(MeshReportTest, ZeroAreaIsExact) {
  const double above = std::nextafter(3.0, 4.0);
  for (double scale : {1.0, 1e-20, 1e20}) {
    TriangleMesh line =
        MeshOf({{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0.3, 0.3, 0.3}, {1, 0, 0}},
               {{0, 1, 2}, {0, 2, 3}});
    line.positions *= scale;
    EXPECT_EQ(ReportOn(line).zero_area_faces, 1u) << scale;
  }
  const TriangleMesh almost =
      MeshOf({{0, 0, 0}, {1, 1, 0}, {3, above, 0}}, {{0, 1, 2}});
  EXPECT_EQ(ReportOn(almost).zero_area_faces, 0u);
  EXPECT_GT(ReportOn(almost).area, 0);
  // The products of these coordinates need more than 53 bits.
  const double x = 1 + std::ldexp(1.0, -40), y = 1 + std::ldexp(1.0, -30);
  const TriangleMesh exact =
      MeshOf({{x, y, 0}, {2 * x, 2 * y, 0}, {4 * x, 4 * y, 0}}, {{0, 1, 2}});
  EXPECT_EQ(ReportOn(exact).zero_area_faces, 1u);
}

}  // namespace
}  // namespace marrow
