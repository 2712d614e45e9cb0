#include <Eigen/Geometry>

#include "client/samples/creature.h"

namespace marrow {
namespace {

using Eigen::Vector3d;

// At rest the left arm runs along this line, 40 degrees below the horizon.
const Vector3d& ArmLine() {
  static const Vector3d line(0.766, -0.643, 0);
  return line;
}

// Lifts the left forearm to the front.
Vector3d ElbowBend(double degrees) {
  return degrees * ArmLine().cross(Vector3d::UnitZ());
}

CreaturePart Torso() {
  CreaturePart torso;
  torso.name = "torso";
  torso.inner_blend = 0.08;
  // A pear: the round belly over the hips, then the narrower shoulders.
  for (const double side : {-1., 1.}) {
    const Vector3d hip(side * 0.085, 0.7, 0);
    const Vector3d belly(side * 0.06, 0.82, 0.025);
    const Vector3d shoulder(side * 0.085, 1.07, 0);
    torso.cones.push_back({hip, belly, 0.18, 0.205});
    torso.cones.push_back({belly, shoulder, 0.205, 0.13});
  }
  return torso;
}

void AddHead(Creature& creature) {
  CreaturePart& head = AddLimb("head",
                               {{{0, 1.22, -0.005}, 0.075},
                                {{0, 1.3, 0.0}, 0.1},
                                {{0, 1.45, 0.01}, 0.2}},
                               0.03, creature);
  head.inner_blend = 0.04;
  // Cheeks, the crown, a nose, a lock of hair and the ears.
  head.cones.push_back({{-0.07, 1.42, 0.02}, {0.07, 1.42, 0.02}, 0.185, 0.185});
  head.cones.push_back({{-0.04, 1.5, -0.02}, {0.04, 1.5, -0.02}, 0.2, 0.2});
  head.cones.push_back({{0, 1.42, 0.2}, {0, 1.42, 0.23}, 0.04, 0.035});
  head.cones.push_back({{0, 1.68, -0.02}, {0.01, 1.75, 0.02}, 0.05, 0.035});
  head.cones.push_back({{0.01, 1.75, 0.02}, {0.05, 1.77, 0.07}, 0.035, 0.02});
  for (const double side : {-1., 1.}) {
    head.cones.push_back(
        {{side * 0.24, 1.41, -0.01}, {side * 0.265, 1.44, -0.03}, 0.045, 0.05});
  }
}

void AddArms(Creature& creature) {
  const Vector3d shoulder(0.21, 1.07, 0);
  const auto at = [&](double distance, double front) -> Vector3d {
    return shoulder + distance * ArmLine() + front * Vector3d::UnitZ();
  };
  AddLimbPair("arm",
              {{shoulder, 0.052},
               {at(0.27, 0), 0.082},
               {at(0.46, 0.005), 0.07},
               {at(0.57, 0.01), 0.088}},
              {{at(0.11, 0), at(0.18, 0), 0.085, 0.088},
               {at(0.49, 0.06), at(0.52, 0.11), 0.04, 0.035}},
              0.02, creature);
}

void AddLegs(Creature& creature) {
  AddLimbPair("leg",
              {{{0.13, 0.56, 0}, 0.065},
               {{0.15, 0.33, 0.01}, 0.092},
               {{0.165, 0.1, 0.0}, 0.09},
               {{0.18, 0.08, 0.14}, 0.08}},
              {{{0.135, 0.47, 0}, {0.14, 0.42, 0}, 0.118, 0.118}}, 0.02,
              creature);
}

CreaturePose Walk() {
  CreaturePose pose{"walk", {}};
  TurnBoth("arm", 0, {0, 0, -30}, pose);
  pose.turns.push_back({"left_arm", 0, {30, 0, 0}});
  pose.turns.push_back({"right_arm", 0, {-32, 0, 0}});
  TurnBoth("arm", 1, ElbowBend(28), pose);
  pose.turns.push_back({"left_leg", 0, {-32, 0, 0}});
  pose.turns.push_back({"left_leg", 1, {14, 0, 0}});
  pose.turns.push_back({"left_leg", 2, {-8, 0, 0}});
  pose.turns.push_back({"right_leg", 0, {22, 0, 0}});
  pose.turns.push_back({"right_leg", 1, {38, 0, 0}});
  pose.turns.push_back({"right_leg", 2, {22, 0, 0}});
  pose.turns.push_back({"torso", 0, {4, 6, 0}});
  return pose;
}

CreaturePose Sit() {
  CreaturePose pose{"sit", {}};
  TurnBoth("leg", 0, {-78, 0, 0}, pose);
  TurnBoth("leg", 1, {72, 0, 0}, pose);
  TurnBoth("arm", 0, {0, 0, -26}, pose);
  TurnBoth("arm", 0, {-32, 0, 0}, pose);
  TurnBoth("arm", 1, ElbowBend(45), pose);
  pose.turns.push_back({"torso", 0, {8, 0, 0}});
  pose.turns.push_back({"head", 1, {10, 25, 0}});
  return pose;
}

CreaturePose Wave() {
  CreaturePose pose{"wave", {}};
  pose.turns.push_back({"right_arm", 0, {0, 0, -48}});
  pose.turns.push_back({"right_arm", 1, {0, 0, -84}});
  pose.turns.push_back({"right_arm", 2, {0, 0, 14}});
  pose.turns.push_back({"left_arm", 0, {0, 0, -22}});
  pose.turns.push_back({"left_arm", 1, ElbowBend(20)});
  pose.turns.push_back({"left_leg", 0, {0, 0, 8}});
  pose.turns.push_back({"torso", 0, {0, 0, 5}});
  pose.turns.push_back({"head", 1, {0, 0, 12}});
  return pose;
}

CreaturePose Run() {
  CreaturePose pose{"run", {}};
  TurnBoth("arm", 0, {0, 0, -28}, pose);
  pose.turns.push_back({"left_arm", 0, {48, 0, 0}});
  pose.turns.push_back({"right_arm", 0, {-46, 0, 0}});
  TurnBoth("arm", 1, ElbowBend(62), pose);
  pose.turns.push_back({"left_leg", 0, {-64, 0, 0}});
  pose.turns.push_back({"left_leg", 1, {62, 0, 0}});
  pose.turns.push_back({"right_leg", 0, {28, 0, 0}});
  pose.turns.push_back({"right_leg", 1, {56, 0, 0}});
  pose.turns.push_back({"right_leg", 2, {20, 0, 0}});
  pose.turns.push_back({"torso", 0, {16, 10, 0}});
  pose.turns.push_back({"head", 1, {-12, 0, 0}});
  return pose;
}

}  // namespace

Creature MakeHumanoid() {
  Creature creature;
  creature.name = "humanoid";
  creature.description = "a person with head, two arms and two legs";
  creature.parts.push_back(Torso());
  creature.joints.push_back(
      {0, 0, {0, 0.85, 0}, Vector3d::UnitY(), 0.24});  // waist
  AddHead(creature);
  AddArms(creature);
  AddLegs(creature);
  creature.poses = {{"rest", {}}, Walk(), Run(), Sit(), Wave()};
  return creature;
}

}  // namespace marrow
