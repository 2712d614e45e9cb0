#include "client/picture/camera.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <vector>

#include "tests/client/picture/shapes.h"

namespace marrow {
namespace {

using Eigen::Vector3f;

std::vector<View> Views(const LabelledMesh& mesh, int count = 2) {
  return ChooseViews(MakeSurface(mesh.mesh, mesh.labels), count);
}

// A torso on two legs, arms stretched out; z is up.
LabelledMesh MakePersonZUp() {
  LabelledMesh person;
  AddBox({-0.5f, -0.3f, 0}, {0.5f, 0.3f, 2}, 0, person);
  AddBox({-0.5f, -0.3f, -2}, {-0.1f, 0.3f, 0}, 1, person);
  AddBox({0.1f, -0.3f, -2}, {0.5f, 0.3f, 0}, 2, person);
  AddBox({-1.5f, -0.2f, 1.5f}, {-0.5f, 0.2f, 1.9f}, 3, person);
  AddBox({0.5f, -0.2f, 1.5f}, {1.5f, 0.2f, 1.9f}, 4, person);
  return person;
}

TEST(CameraTest, ViewsAreRotations) {
  for (const View& view : Views(MakeQuadruped())) {
    EXPECT_LT((view * view.transpose() - View::Identity()).norm(), 1e-5f);
    EXPECT_NEAR(view.determinant(), 1, 1e-5);
  }
}

TEST(CameraTest, AQuadrupedStandsOnItsLegs) {
  for (const View& view : Views(MakeQuadruped())) {
    EXPECT_GT((view * Vector3f::UnitY()).y(), 0.5f);
    EXPECT_NEAR((view * Vector3f::UnitY()).x(), 0, 1e-5);
  }
}

TEST(CameraTest, AQuadrupedWithZUpDoesToo) {
  LabelledMesh animal = MakeQuadruped();
  TurnZUp(animal.mesh);
  for (const View& view : Views(animal)) {
    EXPECT_GT((view * Vector3f::UnitZ()).y(), 0.5f);
  }
}

TEST(CameraTest, APersonStandsThoughItCouldLie) {
  for (const View& view : Views(MakePersonZUp())) {
    EXPECT_GT((view * Vector3f::UnitZ()).y(), 0.5f);
  }
}

TEST(CameraTest, LooksAtTheBroadSide) {
  const View view = Views(MakeQuadruped(), 1).at(0);
  EXPECT_GT(std::abs((view * Vector3f::UnitX()).x()), 0.7f);
}

TEST(CameraTest, TheSecondViewShowsTheOtherSide) {
  LabelledMesh coin;
  AddBox({-1, -1, -0.05f}, {1, 1, 0.05f}, 0, coin);
  AddBox({-0.5f, -0.5f, 0.05f}, {0.5f, 0.5f, 0.1f}, 1, coin);
  AddBox({-0.5f, -0.5f, -0.1f}, {0.5f, 0.5f, -0.05f}, 2, coin);
  const auto views = Views(coin);
  ASSERT_EQ(views.size(), 2u);
  EXPECT_LT(views[0].row(2).z() * views[1].row(2).z(), 0);
}

TEST(CameraTest, TakesASurfaceWithoutArea) {
  EXPECT_EQ(Views({}).size(), 2u);
  LabelledMesh point;
  point.mesh.positions = {{1, 1, 1}};
  point.mesh.AddFace(std::vector<uint32_t>{0, 0, 0});
  point.labels = {0};
  for (const View& view : Views(point)) EXPECT_TRUE(view.allFinite());
}

}  // namespace
}  // namespace marrow
