#include "client/encoder/order_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/segmentation.h"
#include "tests/client/encoder/shapes.h"

namespace marrow {
namespace {

using client::kNone;
using ::testing::ElementsAre;

// A pentagon of triangles of areas 1, 2 and 1, a triangle that the payload
// lacks on its side 0-1, and a vertex (5) that no face uses. The payload has
// the pentagon's triangles backwards, and its points too.
class OrderMapTest : public ::testing::Test {
 protected:
  OrderMapTest() {
    mesh_.positions = {{0, 0, 0},  {2, 0, 0},  {2, 1, 0},
                       {-2, 1, 0}, {-1, 0, 0}, {9, 9, 9}};
    mesh_.AddFace(std::array<uint32_t, 5>{0, 1, 2, 3, 4});
    mesh_.AddFace(Corners3{0, 1, 1});
    origin_.site_of_vertex = {0, 1, 2, 3, 4, 5};
    origin_.triangle_begin = {0, 3, 4};
    origin_.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 1, 1}};
    origin_.triangle_of_decoded_face = {2, 1, 0};
    origin_.site_of_decoded_point = {4, 3, 2, 1, 0};
  }

  std::vector<uint32_t> Labels(const std::vector<uint32_t>& decoded) const {
    return *OrderMap(mesh_, origin_).FaceLabelsInFileOrder(decoded);
  }

  PolygonMesh mesh_;
  PayloadOrigin origin_;
};

TEST_F(OrderMapTest, APolygonHasTheLabelOfItsLargestTriangle) {
  EXPECT_THAT(Labels({3, 8, 3}), ElementsAre(8, 8));  // 2 against 1.5
  EXPECT_THAT(Labels({9, 8, 9}), ElementsAre(8, 8));
  EXPECT_THAT(Labels({3, 9, 9}), ElementsAre(9, 9));
  EXPECT_THAT(Labels({8, 3, 4}), ElementsAre(3, 3));
}

TEST_F(OrderMapTest, OfEqualTrianglesThatOfTheLeastPosition) {
  mesh_.positions[4] = {-4, 0, 0};  // areas 1, 2 and 2
  EXPECT_THAT(Labels({5, 7, 3}), ElementsAre(5, 5));
  EXPECT_THAT(Labels({7, 5, 3}), ElementsAre(7, 7));
}

TEST_F(OrderMapTest, APolygonWithoutAreaHasALabelOfItsOwn) {
  mesh_.positions.assign(6, {0, 0, 0});
  EXPECT_THAT(Labels({5, 4, 7}), ElementsAre(7, 7));
}

TEST_F(OrderMapTest, VerticesTakeTheLabelOfTheirPoint) {
  EXPECT_THAT(
      *OrderMap(mesh_, origin_)
           .VertexLabelsInFileOrder(std::vector<uint32_t>{14, 13, 12, 11, 10}),
      ElementsAre(10, 11, 12, 13, 14, kNone));
}

TEST_F(OrderMapTest, FileVerticesComeSortedAndOnce) {
  const OrderMap order(mesh_, origin_);
  EXPECT_THAT(*order.FileVertices(std::vector<uint32_t>{0, 2, 0, 4}),
              ElementsAre(0, 2, 4));
}

TEST_F(OrderMapTest, AnswersOfTheWrongSizeAreErrors) {
  const OrderMap order(mesh_, origin_);
  const std::vector<uint32_t> four = {1, 2, 3, 4};
  EXPECT_EQ(order.FaceLabelsInFileOrder(four).status().code(),
            absl::StatusCode::kInternal);
  EXPECT_EQ(order.VertexLabelsInFileOrder(four).status().code(),
            absl::StatusCode::kInternal);
  EXPECT_EQ(order.FileVertices(std::vector<uint32_t>{5}).status().code(),
            absl::StatusCode::kInternal);
}

}  // namespace
}  // namespace marrow
