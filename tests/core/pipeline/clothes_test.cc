// Creatures in clothes.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

#include "tests/testing/creature_mesh.h"
#include "tests/testing/invariants.h"
#include "tests/testing/run.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// The surface as it is so many diagonals further out, and `keeps(place)`.
template <typename Keep>
TriangleMesh Layer(const TriangleMesh& body, double out, const Keep& keep) {
  Positions normals = Positions::Zero(body.NumVertices(), 3);
  for (const auto& [u, v, w] : body.faces) {
    const Eigen::RowVector3d a = body.positions.row(v) - body.positions.row(u);
    const Eigen::RowVector3d b = body.positions.row(w) - body.positions.row(u);
    for (uint32_t corner : {u, v, w}) normals.row(corner) += a.cross(b);
  }
  TriangleMesh layer = body;
  layer.positions += out *
                     (body.positions.colwise().maxCoeff() -
                      body.positions.colwise().minCoeff())
                         .norm() *
                     normals.rowwise().normalized();
  std::erase_if(layer.faces, [&](const Triangle& face) {
    return !keep(body.positions.row(face[0]));
  });
  return layer;
}

class ClothesTest : public testing::TestWithParam<Method> {
 protected:
  ClothesTest()
      : body_(MakeCreature("humanoid").mesh),
        bare_(RunOn(body_, Levels(2, GetParam()))) {}

  // That the faces of the body, which come first, have the labels of the bare
  // one.
  void ExpectUnchanged(const RecordingSink& dressed) const {
    ASSERT_EQ(dressed.levels.size(), bare_.levels.size());
    for (size_t i = 0; i < bare_.levels.size(); ++i) {
      std::vector<uint32_t> labels = dressed.levels[i].face_labels;
      labels.resize(body_.NumFaces());
      EXPECT_EQ(labels, bare_.levels[i].face_labels);
    }
    ExpectSoundTree(dressed.mesh.mesh, Adjacency(dressed.mesh.mesh),
                    dressed.tree, dressed.mesh.report.area, true,
                    GetParam() == Method::kMerge);
  }

  const TriangleMesh body_;
  const RecordingSink bare_;
};

TEST_P(ClothesTest, AShirtAndACoatHaveTheLabelsBeneathThem) {
  const double middle = body_.positions.col(1).mean();
  const auto above = [&](const Eigen::RowVector3d& place) {
    return place.y() > middle;
  };
  const RecordingSink run = RunOn(
      Together({body_, Layer(body_, 0.004, above), Layer(body_, 0.008, above)}),
      Levels(2, GetParam()));
  EXPECT_EQ(run.mesh.report.bodies, 1u);
  EXPECT_EQ(run.mesh.report.worn_components, 2u);
  EXPECT_EQ(run.mesh.report.bridges, 0u);
  ExpectUnchanged(run);
}

// Of a body and a whole suit the suit is larger, and the one that is seen.
TEST_P(ClothesTest, ABodyInASuitHasTheLabelsOfTheSuit) {
  const auto all = [](const Eigen::RowVector3d&) { return true; };
  const TriangleMesh suit = Layer(body_, 0.002, all);
  const RecordingSink run =
      RunOn(Together({suit, body_}), Levels(2, GetParam()));
  EXPECT_EQ(run.mesh.report.worn_components, 1u);
  for (const auto& level : run.levels) {
    uint32_t same = 0;
    for (uint32_t f = 0; f < body_.NumFaces(); ++f)
      same += level.face_labels[f] == level.face_labels[body_.NumFaces() + f];
    EXPECT_GE(same, 0.9 * body_.NumFaces());
  }
}

TEST_P(ClothesTest, ACopyChangesNothing) {
  const RecordingSink run =
      RunOn(Together({body_, Scaled(body_, 1 - 1e-4)}), Levels(2, GetParam()));
  EXPECT_EQ(run.mesh.report.worn_components, 1u);
  ExpectUnchanged(run);
}

INSTANTIATE_TEST_SUITE_P(Methods, ClothesTest,
                         testing::Values(Method::kPaper, Method::kMerge));

}  // namespace
}  // namespace marrow
