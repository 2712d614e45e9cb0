#include "client/samples/pose.h"

#include <gtest/gtest.h>

#include <cmath>

namespace marrow {
namespace {

using Eigen::Vector3d;

// An upright body with an arm along +x, bent at x = 2.
Creature BodyWithArm() {
  Creature creature;
  CreaturePart body;
  body.name = "body";
  body.cones = {{{0, 0, 0}, {0, 2, 0}, 0.4, 0.4}};
  creature.parts.push_back(body);
  creature.joints.push_back({0, 0, {0, 0.5, 0}, Vector3d::UnitY(), 0.1});
  AddLimb("arm", {{{0.4, 1, 0}, 0.1}, {{2, 1, 0}, 0.1}, {{3, 1, 0}, 0.1}}, 0.05,
          creature);
  return creature;
}

Vector3d Posed(const std::vector<JointTurn>& turns, const Vector3d& p) {
  const Creature creature = BodyWithArm();
  const CreatureField field(creature);
  return PosePoints(creature, field, {"pose", turns}, {p}).front();
}

TEST(PosePointsTest, LeavesTheRestPoseAlone) {
  EXPECT_EQ(Posed({}, {3.1, 1, 0}), Vector3d(3.1, 1, 0));
}

TEST(PosePointsTest, TurnsWhatIsBeyondTheElbowAndNothingElse) {
  const std::vector<JointTurn> turns = {{"arm", 1, {0, 0, 90}}};
  EXPECT_TRUE(Posed(turns, {3.1, 1, 0}).isApprox(Vector3d(2, 2.1, 0), 1e-12));
  EXPECT_EQ(Posed(turns, {1.5, 1.1, 0}), Vector3d(1.5, 1.1, 0));
  EXPECT_EQ(Posed(turns, {0, 2.4, 0}), Vector3d(0, 2.4, 0));
}

TEST(PosePointsTest, TurnsByHalfAtTheElbow) {
  const Vector3d outside = Posed({{"arm", 1, {0, 0, 90}}}, {2, 0.9, 0});
  const double turn = std::sqrt(0.5);
  EXPECT_TRUE(
      outside.isApprox(Vector3d(2 + 0.1 * turn, 1 - 0.1 * turn, 0), 1e-12));
}

TEST(PosePointsTest, CarriesOuterJointsWithInnerOnes) {
  const std::vector<JointTurn> turns = {{"arm", 0, {0, 0, 90}},
                                        {"arm", 1, {0, 0, 90}}};
  // The shoulder puts the elbow at (0.4, 2.6), the elbow points the hand back.
  EXPECT_TRUE(
      Posed(turns, {3.1, 1, 0}).isApprox(Vector3d(-0.7, 2.6, 0), 1e-12));
}

TEST(PosePointsTest, CarriesALimbWithItsRoot) {
  const std::vector<JointTurn> turns = {{"body", 0, {0, 90, 0}}};
  EXPECT_TRUE(Posed(turns, {3, 1.1, 0}).isApprox(Vector3d(0, 1.1, -3), 1e-12));
  EXPECT_EQ(Posed(turns, {0.4, 0, 0}), Vector3d(0.4, 0, 0));
}

TEST(PosePointsTest, ComposesTheTurnsOfAJointInTheirOrder) {
  const std::vector<JointTurn> turns = {{"arm", 1, {0, 0, 90}},
                                        {"arm", 1, {0, 90, 0}}};
  // Along +x, then up to +y, which the second turn leaves where it is.
  EXPECT_TRUE(Posed(turns, {3.1, 1, 0}).isApprox(Vector3d(2, 2.1, 0), 1e-12));
}

}  // namespace
}  // namespace marrow
