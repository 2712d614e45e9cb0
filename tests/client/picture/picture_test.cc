#include "client/picture/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "client/exporters/palette.h"
#include "tests/client/picture/shapes.h"

namespace marrow {
namespace {

using client::Skeleton;
using ::testing::HasSubstr;

constexpr PictureOptions kSmall = {.width = 400, .height = 200};
constexpr Rgb kDisc = {34, 102, 214};

Skeleton MakeSkeleton() {
  Skeleton skeleton;
  skeleton.joints.resize(3);
  skeleton.joints[0].position = {0, 0.5, 0};
  skeleton.joints[1].parent = 0;
  skeleton.joints[1].articulation = true;
  skeleton.joints[1].position = {1.75, 1, 0};
  skeleton.joints[2].parent = 1;
  skeleton.joints[2].position = {1.75, 1.5, 0};
  return skeleton;
}

int Count(const DecodedPng& png, const Rgb& color) {
  return static_cast<int>(
      std::count(png.pixels.begin(), png.pixels.end(), color));
}

TEST(PictureTest, ShowsEverySegmentOnItsBackground) {
  const auto [mesh, labels] = MakeQuadruped();
  const DecodedPng png =
      DecodePng(DrawPng(mesh, labels, Skeleton{}, kSmall).value());
  EXPECT_EQ(png.width, 400);
  EXPECT_EQ(png.height, 200);
  EXPECT_EQ(png.At(0, 0), (Rgb{247, 247, 245}));
  EXPECT_GT(Count(png, png.At(0, 0)), 400 * 200 / 4);
  for (uint32_t label = 0; label < 6; ++label) {
    EXPECT_GT(CountHue(png, SegmentColor(label)), 100) << label;
  }
}

TEST(PictureTest, BothPanelsShowTheSkeleton) {
  const auto [mesh, labels] = MakeQuadruped();
  const std::vector<uint32_t> one_label(mesh.NumFaces(), 0);
  const auto discs = [&, &mesh = mesh](const PictureOptions& options,
                                       const Skeleton& skeleton) {
    return Count(DecodePng(DrawPng(mesh, one_label, skeleton, options).value()),
                 kDisc);
  };
  EXPECT_EQ(discs(kSmall, Skeleton{}), 0);
  const int two = discs(kSmall, MakeSkeleton());
  const int one =
      discs({.width = 400, .height = 200, .num_views = 1}, MakeSkeleton());
  EXPECT_GT(one, 6);
  EXPECT_GT(two, 1.5 * one);
}

TEST(PictureTest, SameInputSameBytes) {
  const auto [mesh, labels] = MakeQuadruped();
  EXPECT_EQ(DrawPng(mesh, labels, MakeSkeleton(), kSmall).value(),
            DrawPng(mesh, labels, MakeSkeleton(), kSmall).value());
}

TEST(PictureTest, ScaleAndPlaceDoNotMatter) {
  auto [mesh, labels] = MakeQuadruped();
  const std::string before = DrawPng(mesh, labels, {}, kSmall).value();
  for (auto& position : mesh.positions) {
    for (double& x : position) x *= 4;
  }
  EXPECT_EQ(DrawPng(mesh, labels, {}, kSmall).value(), before);
}

TEST(PictureTest, TakesAnyMesh) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float big = std::numeric_limits<float>::max();
  const std::vector<std::vector<std::array<double, 3>>> corners = {
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
      {{nan, nan, nan}, {1, 0, 0}, {0, 1, 0}},
      {{2, 2, 2}, {2, 2, 2}, {2, 2, 2}},
      {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}},
      {{-big, 0, big}, {big, 0, 0}, {0, big, -big}},
      {{0, 0, 0}, {1e-38f, 0, 0}, {0, 1e-40f, 0}}};
  for (const auto& positions : corners) {
    PolygonMesh mesh;
    mesh.positions = positions;
    mesh.positions.push_back({99, nan, 99});
    mesh.AddFace(std::vector<uint32_t>{0, 1, 2});
    const auto png = DrawPng(mesh, std::vector<uint32_t>{client::kNone},
                             MakeSkeleton(), kSmall);
    ASSERT_TRUE(png.ok()) << png.status();
    EXPECT_EQ(DecodePng(*png).width, 400);
  }
}

TEST(PictureTest, AnEmptyMeshGivesAnEmptyPicture) {
  const DecodedPng png =
      DecodePng(DrawPng(PolygonMesh{}, {}, Skeleton{}, kSmall).value());
  EXPECT_EQ(Count(png, png.At(0, 0)), 400 * 200);
}

TEST(PictureTest, TakesTheSmallestAndOddSizes) {
  const auto [mesh, labels] = MakeQuadruped();
  for (const auto& [width, height] :
       {std::pair(16, 16), std::pair(16, 301), std::pair(333, 17)}) {
    const DecodedPng png = DecodePng(DrawPng(mesh, labels, MakeSkeleton(),
                                             {.width = width, .height = height})
                                         .value());
    EXPECT_EQ(png.width, width);
    EXPECT_EQ(png.height, height);
  }
}

TEST(PictureTest, RefusesWhatItCannotDraw) {
  const auto [mesh, labels] = MakeQuadruped();
  EXPECT_THAT(std::string(DrawPng(mesh, {}, {}, kSmall).status().message()),
              HasSubstr("0 face labels for a mesh of 36 faces"));
  for (const PictureOptions& options :
       {PictureOptions{.width = 15}, PictureOptions{.height = 4097},
        PictureOptions{.num_views = 0}, PictureOptions{.num_views = 3}}) {
    EXPECT_EQ(DrawPng(mesh, labels, {}, options).status().code(),
              absl::StatusCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace marrow
