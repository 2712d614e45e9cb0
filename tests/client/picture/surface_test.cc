#include "client/picture/surface.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/client/picture/shapes.h"

namespace marrow {
namespace {

using Eigen::Vector3f;

TEST(SurfaceTest, FitsTheLongestSideIntoTwo) {
  LabelledMesh box;
  AddBox({10, 20, 30}, {14, 22, 31}, 7, box);
  const Surface surface = MakeSurface(box.mesh, box.labels);
  EXPECT_EQ(surface.triangles.size(), 12u);
  EXPECT_EQ(surface.labels, std::vector<uint32_t>(12, 7));
  EXPECT_EQ(surface.points[0], Vector3f(-1, -0.5f, -0.25f));
  EXPECT_EQ(surface.Place({14, 22, 31}), Vector3f(1, 0.5f, 0.25f));
}

TEST(SurfaceTest, NormalsPointOutAndWeighFacesByAngle) {
  LabelledMesh box;
  AddBox({-1, -1, -1}, {1, 1, 1}, 0, box);
  const Surface surface = MakeSurface(box.mesh, box.labels);
  // Weighed by area or by count, the diagonals of the quads would show.
  for (size_t v = 0; v < surface.points.size(); ++v) {
    EXPECT_LT((surface.normals[v] - surface.points[v].normalized()).norm(),
              1e-5f);
  }
}

TEST(SurfaceTest, WeldsRepeatedPositions) {
  LabelledMesh soup;
  soup.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                         {1, 0, 0}, {0, 1, 0}, {1, 1, 1}};
  soup.mesh.AddFace(std::vector<uint32_t>{0, 1, 2});
  soup.mesh.AddFace(std::vector<uint32_t>{3, 5, 4});
  const Surface surface = MakeSurface(soup.mesh, std::vector<uint32_t>{0, 0});
  EXPECT_EQ(surface.points.size(), 4u);
}

TEST(SurfaceTest, LeavesOutWhatCannotBeDrawn) {
  LabelledMesh mesh;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  mesh.mesh.positions = {{0, 0, 0},   {1, 0, 0},   {0, 1, 0},
                         {nan, 0, 0}, {0, inf, 0}, {1e30f, 0, 0}};
  mesh.mesh.AddFace(std::vector<uint32_t>{0, 1, 3});
  mesh.mesh.AddFace(std::vector<uint32_t>{0, 1, 2});
  mesh.mesh.AddFace(std::vector<uint32_t>{0, 4, 2});
  mesh.mesh.AddFace(std::vector<uint32_t>{0, 1});
  const Surface surface =
      MakeSurface(mesh.mesh, std::vector<uint32_t>{1, 2, 3, 4});
  EXPECT_EQ(surface.labels, std::vector<uint32_t>{2});
  EXPECT_EQ(surface.points.size(), 3u);
  EXPECT_EQ(surface.scale, 2.0);  // the far vertex has no face
}

TEST(SurfaceTest, KeepsTheLargestFloatsFinite) {
  const float big = std::numeric_limits<float>::max();
  LabelledMesh mesh;
  mesh.mesh.positions = {{-big, 0, 0}, {big, 0, 0}, {0, big, 0}};
  mesh.mesh.AddFace(std::vector<uint32_t>{0, 1, 2});
  const Surface surface = MakeSurface(mesh.mesh, std::vector<uint32_t>{0});
  EXPECT_EQ(surface.points[1].x(), 1);
  EXPECT_EQ(surface.points[0].x(), -1);
}

}  // namespace
}  // namespace marrow
