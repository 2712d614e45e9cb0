#include "client/samples/creature.h"

namespace marrow {
namespace {

using Eigen::Vector3d;

CreaturePart Torso() {
  CreaturePart torso;
  torso.name = "torso";
  torso.inner_blend = 0.08;
  for (const double side : {-1., 1.}) {
    const Vector3d hip(side * 0.07, 0.76, -0.26);
    const Vector3d belly(side * 0.06, 0.75, 0.02);
    const Vector3d chest(side * 0.07, 0.77, 0.26);
    torso.cones.push_back({hip, belly, 0.215, 0.225});
    torso.cones.push_back({belly, chest, 0.225, 0.225});
  }
  return torso;
}

void AddHead(Creature& creature) {
  CreaturePart& head = AddLimb("head",
                               {{{0, 0.95, 0.41}, 0.085},
                                {{0, 1.05, 0.49}, 0.11},
                                {{0, 1.21, 0.58}, 0.21},
                                {{0, 1.13, 0.84}, 0.085}},
                               0.03, creature);
  head.inner_blend = 0.06;
  for (const double side : {-1., 1.}) {
    head.cones.push_back(
        {{side * 0.14, 1.34, 0.53}, {side * 0.2, 1.47, 0.5}, 0.075, 0.045});
  }
}

void AddLegs(Creature& creature) {
  AddLimbPair("foreleg",
              {{{0.18, 0.56, 0.29}, 0.06},
               {{0.2, 0.37, 0.28}, 0.115},
               {{0.205, 0.22, 0.28}, 0.1},
               {{0.21, 0.1, 0.28}, 0.1},
               {{0.21, 0.09, 0.38}, 0.09}},
              {{{0.19, 0.47, 0.29}, {0.195, 0.42, 0.28}, 0.105, 0.115}}, 0.02,
              creature);
  AddLimbPair("hindleg",
              {{{0.18, 0.56, -0.29}, 0.06},
               {{0.2, 0.38, -0.26}, 0.12},
               {{0.205, 0.22, -0.3}, 0.1},
               {{0.21, 0.1, -0.28}, 0.1},
               {{0.21, 0.09, -0.18}, 0.09}},
              {{{0.19, 0.47, -0.28}, {0.195, 0.42, -0.27}, 0.11, 0.12}}, 0.02,
              creature);
}

CreaturePose Walk() {
  CreaturePose pose{"walk", {}};
  pose.turns = {
      {"left_foreleg", 0, {-26, 0, 0}},  {"left_foreleg", 1, {10, 0, 0}},
      {"right_foreleg", 0, {18, 0, 0}},  {"right_foreleg", 1, {-24, 0, 0}},
      {"right_foreleg", 2, {42, 0, 0}},  {"left_hindleg", 0, {20, 0, 0}},
      {"left_hindleg", 1, {12, 0, 0}},   {"left_hindleg", 2, {-10, 0, 0}},
      {"right_hindleg", 0, {-24, 0, 0}}, {"right_hindleg", 1, {22, 0, 0}},
      {"right_hindleg", 2, {-14, 0, 0}}, {"head", 0, {8, 12, 0}},
      {"tail", 0, {0, 18, 0}},           {"tail", 1, {0, 18, 0}},
  };
  return pose;
}

CreaturePose Gallop() {
  CreaturePose pose{"gallop", {}};
  pose.turns = {
      {"left_foreleg", 0, {-58, 0, 0}},  {"left_foreleg", 1, {16, 0, 0}},
      {"right_foreleg", 0, {-44, 0, 0}}, {"right_foreleg", 1, {-6, 0, 0}},
      {"right_foreleg", 2, {48, 0, 0}},  {"left_hindleg", 0, {42, 0, 0}},
      {"left_hindleg", 1, {-14, 0, 0}},  {"left_hindleg", 2, {24, 0, 0}},
      {"right_hindleg", 0, {30, 0, 0}},  {"right_hindleg", 1, {-6, 0, 0}},
      {"right_hindleg", 2, {26, 0, 0}},  {"head", 0, {22, 0, 0}},
      {"head", 2, {-14, 0, 0}},          {"tail", 0, {40, 0, 0}},
      {"tail", 1, {15, 0, 0}},           {"torso", 0, {-8, 0, 0}},
  };
  return pose;
}

CreaturePose Graze() {
  CreaturePose pose{"graze", {}};
  pose.turns = {
      {"head", 0, {68, 0, 0}},           {"head", 1, {22, 0, 0}},
      {"head", 2, {-28, 0, 0}},          {"left_foreleg", 0, {-20, 0, 8}},
      {"right_foreleg", 0, {14, 0, -6}}, {"right_foreleg", 1, {-8, 0, 0}},
      {"tail", 0, {28, 0, 0}},           {"tail", 1, {20, 30, 0}},
      {"tail", 2, {0, 30, 0}},
  };
  return pose;
}

CreaturePose Crouch() {
  CreaturePose pose{"crouch", {}};
  TurnBoth("hindleg", 0, {-40, 0, 0}, pose);
  TurnBoth("hindleg", 1, {46, 0, 0}, pose);
  TurnBoth("hindleg", 2, {-40, 0, 0}, pose);
  TurnBoth("foreleg", 0, {40, 0, 0}, pose);
  pose.turns.push_back({"torso", 0, {-24, 0, 0}});
  pose.turns.push_back({"head", 0, {14, 0, 0}});
  pose.turns.push_back({"head", 1, {12, 20, 0}});
  pose.turns.push_back({"tail", 0, {30, 0, 0}});
  pose.turns.push_back({"tail", 1, {0, 35, 0}});
  return pose;
}

}  // namespace

Creature MakeQuadruped() {
  Creature creature;
  creature.name = "quadruped";
  creature.description = "a four-legged animal with head and tail";
  creature.parts.push_back(Torso());
  creature.joints.push_back({0,
                             0,
                             {0, 0.75, -0.02},
                             Vector3d::UnitZ(),
                             0.32});  // the small of the back
  AddHead(creature);
  AddLegs(creature);
  CreaturePart& tail = AddLimb("tail",
                               {{{0, 0.9, -0.47}, 0.05},
                                {{0, 1.0, -0.62}, 0.095},
                                {{0, 1.14, -0.72}, 0.11},
                                {{0, 1.3, -0.76}, 0.045}},
                               0.02, creature);
  tail.inner_blend = 0.04;
  creature.poses = {{"rest", {}}, Walk(), Gallop(), Graze(), Crouch()};
  return creature;
}

}  // namespace marrow
