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
  torso.inner_blend = 0.04;
  // Two columns side by side, from the hips over the waist to the shoulders.
  for (const double side : {-1., 1.}) {
    const Vector3d hip(side * 0.085, 0.96, 0);
    const Vector3d waist(side * 0.075, 1.14, 0.01);
    const Vector3d breast(side * 0.11, 1.31, 0.01);
    const Vector3d shoulder(side * 0.15, 1.4, 0);
    torso.cones.push_back({hip, waist, 0.135, 0.125});
    torso.cones.push_back({waist, breast, 0.125, 0.14});
    torso.cones.push_back({breast, shoulder, 0.14, 0.09});
  }
  torso.cones.push_back({{-0.085, 0.96, 0}, {0.085, 0.96, 0}, 0.13, 0.13});
  torso.cones.push_back({{-0.15, 1.4, 0}, {0.15, 1.4, 0}, 0.09, 0.09});
  return torso;
}

void AddHead(Creature& creature) {
  CreaturePart& head = AddLimb("head",
                               {{{0, 1.44, -0.01}, 0.065},
                                {{0, 1.57, 0.005}, 0.06},
                                {{0, 1.71, 0.0}, 0.115}},
                               0.03, creature);
  head.inner_blend = 0.04;
  head.cones.push_back({{0, 1.755, -0.025}, {0, 1.72, 0.012}, 0.122, 0.115});
  head.cones.push_back({{0, 1.645, 0.05}, {0, 1.625, 0.065}, 0.066, 0.054});
  head.cones.push_back({{0, 1.72, 0.12}, {0, 1.68, 0.145}, 0.014, 0.02});
  for (const double side : {-1., 1.}) {
    head.cones.push_back({{side * 0.117, 1.68, -0.015},
                          {side * 0.13, 1.72, -0.025},
                          0.017,
                          0.023});
  }
}

void AddArms(Creature& creature) {
  const Vector3d shoulder(0.215, 1.385, 0);
  const auto at = [&](double distance, double front) -> Vector3d {
    return shoulder + distance * ArmLine() + front * Vector3d::UnitZ();
  };
  AddLimbPair("arm",
              {{shoulder, 0.08},
               {at(0.27, -0.005), 0.056},
               {at(0.51, 0.005), 0.042},
               {at(0.66, 0.01), 0.03}},
              {{at(0.08, 0.015), at(0.17, 0.012), 0.066, 0.06},
               {at(0.32, 0), at(0.38, 0), 0.059, 0.052},
               {at(0.55, 0.034), at(0.61, 0.036), 0.031, 0.031},
               {at(0.55, -0.02), at(0.61, -0.022), 0.031, 0.03},
               {at(0.62, 0.04), at(0.68, 0.04), 0.026, 0.022},
               {at(0.62, -0.018), at(0.68, -0.02), 0.026, 0.022},
               {at(0.54, 0.04), at(0.59, 0.095), 0.027, 0.022}},
              0.05, creature);
}

void AddLegs(Creature& creature) {
  AddLimbPair("leg",
              {{{0.115, 0.89, 0}, 0.1},
               {{0.155, 0.51, 0.015}, 0.064},
               {{0.185, 0.09, -0.025}, 0.04},
               {{0.205, 0.035, 0.13}, 0.032}},
              {{{0.155, 0.42, -0.012}, {0.168, 0.3, -0.025}, 0.058, 0.05},
               {{0.185, 0.045, -0.05}, {0.195, 0.04, 0.06}, 0.042, 0.04},
               {{0.225, 0.033, 0.1}, {0.232, 0.03, 0.15}, 0.03, 0.026},
               {{0.185, 0.033, 0.12}, {0.19, 0.03, 0.17}, 0.03, 0.027}},
              0.045, creature);
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
  TurnBoth("leg", 0, {-82, 0, 0}, pose);
  TurnBoth("leg", 1, {84, 0, 0}, pose);
  TurnBoth("arm", 0, {0, 0, -26}, pose);
  TurnBoth("arm", 0, {-38, 0, 0}, pose);
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
  TurnBoth("arm", 1, ElbowBend(82), pose);
  pose.turns.push_back({"left_leg", 0, {-72, 0, 0}});
  pose.turns.push_back({"left_leg", 1, {78, 0, 0}});
  pose.turns.push_back({"right_leg", 0, {28, 0, 0}});
  pose.turns.push_back({"right_leg", 1, {68, 0, 0}});
  pose.turns.push_back({"right_leg", 2, {30, 0, 0}});
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
      {0, 0, {0, 1.12, 0}, Vector3d::UnitY(), 0.16});  // waist
  AddHead(creature);
  AddArms(creature);
  AddLegs(creature);
  creature.poses = {{"rest", {}}, Walk(), Run(), Sit(), Wave()};
  return creature;
}

}  // namespace marrow
