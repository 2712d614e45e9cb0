#include "client/picture/overlay.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace marrow {
namespace {

using client::Skeleton;
using Eigen::Vector2f;

const Color kGreen(0, 1, 0);

Skeleton MakeChain() {
  Skeleton chain;
  chain.joints.resize(3);
  chain.joints[1].parent = 0;
  chain.joints[1].articulation = true;
  chain.joints[2].parent = 1;
  return chain;
}

bool IsBlue(const Color& c) { return c.z() > 2 * c.x() && c.z() > 2 * c.y(); }

bool IsGray(const Color& c) {
  return std::abs(c.x() - c.z()) < 0.1f && c.x() > 0.2f && c.x() < 0.5f;
}

TEST(OverlayTest, DrawsDiscsAndBones) {
  Image image(100, 40, kGreen);
  DrawSkeleton(MakeChain(), {{20, 20}, {50, 20}, {80, 20}}, 2, image);
  EXPECT_TRUE(IsBlue(image.At(20, 20)));
  EXPECT_TRUE(IsGray(image.At(50, 20)));
  EXPECT_TRUE(IsBlue(image.At(80, 20)));
  EXPECT_LT(image.At(65, 20).maxCoeff(), 0.1f);  // the bone
  EXPECT_GT(image.At(65, 18).minCoeff(), 0.4f);  // its outline
  EXPECT_EQ(image.At(65, 30), kGreen);
}

TEST(OverlayTest, MarksTheRoot) {
  Image image(100, 40, kGreen);
  DrawSkeleton(MakeChain(), {{20, 20}, {50, 20}, {80, 20}}, 2, image);
  // Three bone widths off its centre the root has its dark ring.
  EXPECT_LT(image.At(20, 20 + 6).maxCoeff(), 0.1f);
  EXPECT_EQ(image.At(80, 20 + 7), kGreen);
}

TEST(OverlayTest, BonesMaySlope) {
  for (const Vector2f& end : {Vector2f(90, 90), Vector2f(12, 90)}) {
    Image image(100, 100, kGreen);
    DrawSkeleton(MakeChain(), {{10, 10}, end, end}, 2, image);
    const Vector2f middle = (Vector2f(10, 10) + end) / 2;
    EXPECT_LT(image.At(int(middle.x()), int(middle.y())).maxCoeff(), 0.1f);
  }
}

TEST(OverlayTest, TakesJointsFarOutsideAndNowhere) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const Vector2f& odd :
       {Vector2f(nan, 1), Vector2f(inf, 1), Vector2f(1e30f, -1e30f)}) {
    Image image(50, 50, kGreen);
    DrawSkeleton(MakeChain(), {{20, 20}, odd, {40, 40}}, 2, image);
    EXPECT_TRUE(IsBlue(image.At(20, 20)));
    EXPECT_TRUE(IsBlue(image.At(40, 40)));
    EXPECT_EQ(image.At(30, 30), kGreen);
  }
  Image image(50, 50, kGreen);
  DrawSkeleton(MakeChain(), {{25, 25}, {9e5f, 25}, {25, -9e5f}}, 2, image);
  EXPECT_LT(image.At(45, 25).maxCoeff(), 0.1f);
}

TEST(OverlayTest, AnEmptySkeletonDrawsNothing) {
  Image image(9, 9, kGreen);
  DrawSkeleton({}, {}, 2, image);
  for (const Color& pixel : image.pixels) EXPECT_EQ(pixel, kGreen);
}

}  // namespace
}  // namespace marrow
