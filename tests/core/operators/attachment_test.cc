#include "core/operators/attachment.h"

#include <numeric>
#include <utility>
#include <vector>

#include "core/mesh/components.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

TriangleMesh BallAt(double x, double radius) {
  TriangleMesh ball = Scaled(Icosphere(3), radius);
  ball.positions.col(0).array() += x;
  return ball;
}

// Of a ball of that radius what is above -0.5.
TriangleMesh Shirt(double radius) {
  TriangleMesh shirt = BallAt(0, radius);
  std::erase_if(shirt.faces, [&](const Triangle& face) {
    return shirt.positions(face[0], 2) < -0.5;
  });
  return CanonicalOf(shirt).mesh;
}

std::vector<bool> WornOf(const std::vector<TriangleMesh>& shells, double near) {
  const TriangleMesh mesh = Together(shells);
  std::vector<std::vector<uint32_t>> components;
  uint32_t first = 0;
  for (const TriangleMesh& shell : shells) {
    std::vector<uint32_t>& faces = components.emplace_back(shell.NumFaces());
    std::iota(faces.begin(), faces.end(), first);
    first += shell.NumFaces();
  }
  return FindWorn(mesh, components, near, CancelToken()).value();
}

TEST(AttachmentTest, ClothesAreWornAndTheBodyIsNot) {
  const std::vector<bool> worn =
      WornOf({BallAt(0, 1), Shirt(1.02), Shirt(1.04)}, 0.03);
  EXPECT_EQ(worn, (std::vector<bool>{false, true, true}));
}

TEST(AttachmentTest, OfCopiesTheLargestIsLeft) {
  EXPECT_EQ(WornOf({BallAt(0, 1.002), BallAt(0, 1.001), BallAt(0, 1)}, 0.03),
            (std::vector<bool>{false, true, true}));
}

TEST(AttachmentTest, NeighboursAreNotWorn) {
  EXPECT_EQ(WornOf({BallAt(0, 1), BallAt(2, 0.99), BallAt(3.97, 0.98)}, 0.03),
            std::vector<bool>(3, false));
  EXPECT_EQ(WornOf({Shirt(1.2), BallAt(0, 1)}, 0.03),
            std::vector<bool>(2, false));
  // Within twelve large triangles, and near none of them.
  TriangleMesh box = Icosphere(0);
  box.positions *= 2;
  EXPECT_EQ(WornOf({box, BallAt(0, 1)}, 0.03), std::vector<bool>(2, false));
}

// All of a neck is near one of two balls, and holds them together.
TEST(AttachmentTest, ANeckIsNotWorn) {
  TriangleMesh neck = BallAt(0, 0.3);
  neck.positions.col(0) *= 0.05;
  neck.positions.col(0).array() += 1.02;
  EXPECT_EQ(WornOf({BallAt(0, 1), BallAt(2.04, 0.99), neck}, 0.1),
            std::vector<bool>(3, false));
}

// Closed and thin: its far side is near as well.
TEST(AttachmentTest, ALimbThatLiesAgainstTheBodyIsNotWorn) {
  TriangleMesh wing = BallAt(0, 1.02);
  for (Eigen::Index v = 0; v < wing.positions.rows(); ++v)
    if (wing.positions(v, 2) < 0.6) wing.positions.row(v) *= 1.015 / 1.02;
  for (Eigen::Index v = 0; v < wing.positions.rows(); ++v)
    if (wing.positions(v, 2) < 0) wing.positions(v, 2) *= -1;
  EXPECT_EQ(WornOf({BallAt(0, 1), wing}, 0.03), std::vector<bool>(2, false));
}

std::vector<uint32_t> Faces(uint32_t begin, uint32_t end) {
  std::vector<uint32_t> faces(end - begin);
  std::iota(faces.begin(), faces.end(), begin);
  return faces;
}

// A ring around the left of two balls comes nearer to the right one in a point.
TEST(AttachmentTest, AStrapFollowsWhatItIsAround) {
  TriangleMesh ring = BallAt(0, 1.2);
  for (Eigen::Index v = 0; v < ring.positions.rows(); ++v)
    ring.positions(v, 2) *= 0.1;
  const TriangleMesh mesh = Together({BallAt(0, 1), BallAt(2.25, 1), ring});
  const uint32_t ball = Icosphere(3).NumFaces();
  std::vector<uint32_t> anchors = Faces(0, 3 * ball);
  ASSERT_TRUE(Attach(mesh, Faces(0, 2 * ball), {{Faces(2 * ball, 3 * ball)}},
                     0.03, CancelToken(), anchors)
                  .ok());
  for (uint32_t f = 0; f < 2 * ball; ++f) EXPECT_EQ(anchors[f], f);
  for (uint32_t f = 2 * ball; f < 3 * ball; ++f) {
    EXPECT_LT(anchors[f], ball);
    EXPECT_EQ(anchors[f], anchors[2 * ball]);
  }
}

TEST(AttachmentTest, EachFaceOfWhatIsWornFollowsTheFaceBeneathIt) {
  const TriangleMesh mesh = Together({BallAt(0, 1), BallAt(0, 1.01)});
  const uint32_t ball = Icosphere(3).NumFaces();
  std::vector<uint32_t> anchors = Faces(0, 2 * ball);
  const std::vector<uint32_t> body = Faces(0, ball);
  ASSERT_TRUE(Attach(mesh, body, {{Faces(ball, 2 * ball), true}}, 0.03,
                     CancelToken(), anchors)
                  .ok());
  uint32_t beneath = 0;
  for (uint32_t f = 0; f < ball; ++f) {
    const Triangle &a = mesh.faces[f], &b = mesh.faces[anchors[ball + f]];
    beneath += std::ranges::any_of(
        a, [&](uint32_t v) { return std::ranges::find(b, v) != b.end(); });
  }
  EXPECT_EQ(beneath, ball);
}

// The hidden body has the label of its suit, which is attached itself.
TEST(AttachmentTest, WhatWearsMayBeAttached) {
  const TriangleMesh mesh =
      Together({BallAt(0, 1), BallAt(1.3, 0.2), BallAt(1.3, 0.195)});
  const uint32_t ball = Icosphere(3).NumFaces();
  std::vector<uint32_t> anchors = Faces(0, 3 * ball);
  ASSERT_TRUE(
      Attach(mesh, Faces(0, ball),
             {{Faces(2 * ball, 3 * ball), true}, {Faces(ball, 2 * ball)}}, 0.03,
             CancelToken(), anchors)
          .ok());
  for (uint32_t f = ball; f < 3 * ball; ++f) {
    EXPECT_LT(anchors[f], ball);
    EXPECT_EQ(anchors[f], anchors[ball]);
  }
}

TEST(AttachmentTest, StopsWhenCancelled) {
  CancelToken cancel;
  cancel.Cancel();
  const TriangleMesh mesh = Together({BallAt(0, 1), BallAt(0, 1.01)});
  const uint32_t ball = Icosphere(3).NumFaces();
  const std::vector<uint32_t> body = Faces(0, ball);
  EXPECT_TRUE(absl::IsCancelled(
      FindWorn(mesh, {body, Faces(ball, 2 * ball)}, 0.03, cancel).status()));
  std::vector<uint32_t> anchors = Faces(0, 2 * ball);
  EXPECT_TRUE(absl::IsCancelled(Attach(
      mesh, body, {{Faces(ball, 2 * ball), true}}, 0.03, cancel, anchors)));
}

}  // namespace
}  // namespace marrow
