#include "client/picture/shading.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/client/picture/shapes.h"

namespace marrow {
namespace {

using Eigen::Vector3f;

const Color kBackground(1, 1, 1);

// Looks along -z at a mesh that fills the middle half of 64 x 64 pixels.
Image Render(const LabelledMesh& mesh) {
  const Surface surface = MakeSurface(mesh.mesh, mesh.labels);
  std::vector<Vector3f> points;
  for (const Vector3f& p : surface.points) {
    points.push_back(kSupersampling *
                     Vector3f(32 + 16 * p.x(), 32 - 16 * p.y(), 16 * p.z()));
  }
  DepthBuffer buffer(64 * kSupersampling, 64 * kSupersampling);
  Rasterize(points, surface.triangles, buffer);
  Image image(64, 64, kBackground);
  Shade(surface, View::Identity(), points, buffer, 0, image);
  return image;
}

LabelledMesh MakeHalves(uint32_t left, uint32_t right) {
  LabelledMesh mesh;
  AddBox({-1, -1, -1}, {0, 1, 1}, left, mesh);
  AddBox({0, -1, -1}, {1, 1, 1}, right, mesh);
  return mesh;
}

TEST(ShadingTest, ColoursSegmentsAndLeavesTheBackground) {
  Image image = Render(MakeHalves(1, 2));
  EXPECT_EQ(image.At(5, 5), kBackground);
  const Color left = image.At(24, 32).normalized();
  const Color right = image.At(40, 32).normalized();
  EXPECT_GT(left.dot(ToLinear(SegmentColor(1)).normalized()), 0.97f);
  EXPECT_GT(right.dot(ToLinear(SegmentColor(2)).normalized()), 0.97f);
}

TEST(ShadingTest, DrawsALineOnlyBetweenSegments) {
  Image cut = Render(MakeHalves(1, 2));
  Image whole = Render(MakeHalves(1, 1));
  EXPECT_LT(cut.At(32, 32).sum(), 0.5f * cut.At(24, 32).sum());
  EXPECT_GT(whole.At(32, 32).sum(), 0.8f * whole.At(24, 32).sum());
}

TEST(ShadingTest, LightComesFromAbove) {
  LabelledMesh roof;
  roof.mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {-1, 0, 1}, {1, 0, 1},
                         {-1, 0, 1},  {1, 0, 1},  {-1, 1, 0}, {1, 1, 0}};
  roof.mesh.AddFace(std::vector<uint32_t>{0, 1, 3, 2});
  roof.mesh.AddFace(std::vector<uint32_t>{4, 5, 7, 6});
  roof.labels = {0, 0};
  Image image = Render(roof);
  EXPECT_GT(image.At(32, 20).sum(), 1.3f * image.At(32, 44).sum());
}

TEST(ShadingTest, TurnedOverFacesLookTheSame) {
  LabelledMesh sheet;
  sheet.mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0.3f}, {-1, 1, 0.3f}};
  sheet.mesh.AddFace(std::vector<uint32_t>{0, 1, 2, 3});
  sheet.labels = {0};
  LabelledMesh turned = sheet;
  turned.mesh.face_vertices = {3, 2, 1, 0};
  EXPECT_LT((Render(sheet).At(32, 32) - Render(turned).At(32, 32)).norm(),
            1e-4f);
}

// A sheet that rises by `rise` from the viewer's feet to the back.
LabelledMesh MakeSheet(float rise) {
  LabelledMesh sheet;
  sheet.mesh.positions = {
      {-1, -1, rise}, {1, -1, rise}, {1, 1, -rise}, {-1, 1, -rise}};
  sheet.mesh.AddFace(std::vector<uint32_t>{0, 1, 2, 3});
  sheet.labels = {0};
  return sheet;
}

TEST(ShadingTest, HollowsAreDarker) {
  LabelledMesh walled = MakeSheet(0);
  AddBox({-0.9f, -0.9f, 0}, {-0.2f, 0.9f, 0.3f}, 0, walled);
  AddBox({0.2f, -0.9f, 0}, {0.9f, 0.9f, 0.3f}, 0, walled);
  EXPECT_LT(Render(walled).At(32, 32).sum(),
            0.95f * Render(MakeSheet(0)).At(32, 32).sum());
}

TEST(ShadingTest, AnOpenSlopeIsNotAHollow) {
  EXPECT_GT(Render(MakeSheet(1)).At(32, 32).sum(),
            1.05f * Render(MakeSheet(0)).At(32, 32).sum());
}

}  // namespace
}  // namespace marrow
