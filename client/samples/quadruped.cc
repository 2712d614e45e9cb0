#include "client/samples/creature.h"

namespace marrow {
namespace {

using Eigen::Vector3d;

CreaturePart Torso() {
  CreaturePart torso;
  torso.name = "torso";
  torso.inner_blend = 0.05;
  for (const double side : {-1., 1.}) {
    const Vector3d hip(side * 0.07, 0.97, -0.44);
    const Vector3d belly(side * 0.05, 0.97, 0.0);
    const Vector3d chest(side * 0.07, 0.96, 0.38);
    torso.cones.push_back({hip, belly, 0.2, 0.19});
    torso.cones.push_back({belly, chest, 0.19, 0.22});
  }
  return torso;
}

void AddHead(Creature& creature) {
  CreaturePart& head = AddLimb("head",
                               {{{0, 1.08, 0.47}, 0.135},
                                {{0, 1.3, 0.64}, 0.1},
                                {{0, 1.48, 0.76}, 0.1},
                                {{0, 1.42, 1.02}, 0.055}},
                               0.08, creature);
  head.inner_blend = 0.05;
  head.cones.push_back({{0, 1.51, 0.78}, {0, 1.49, 0.84}, 0.11, 0.095});
  head.cones.push_back({{0, 1.43, 0.86}, {0, 1.395, 0.98}, 0.07, 0.05});
  for (const double side : {-1., 1.}) {
    head.cones.push_back(
        {{side * 0.065, 1.58, 0.72}, {side * 0.095, 1.73, 0.7}, 0.042, 0.022});
  }
}

void AddLegs(Creature& creature) {
  AddLimbPair("foreleg",
              {{{0.17, 0.85, 0.38}, 0.1},
               {{0.18, 0.62, 0.34}, 0.08},
               {{0.185, 0.38, 0.375}, 0.056},
               {{0.185, 0.17, 0.365}, 0.05},
               {{0.185, 0.12, 0.45}, 0.05}},
              {}, 0.06, creature);
  AddLimbPair("hindleg",
              {{{0.165, 0.86, -0.46}, 0.115},
               {{0.18, 0.65, -0.39}, 0.09},
               {{0.185, 0.43, -0.54}, 0.058},
               {{0.185, 0.17, -0.5}, 0.05},
               {{0.185, 0.12, -0.41}, 0.05}},
              {}, 0.06, creature);
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
                             {0, 1.0, -0.05},
                             Vector3d::UnitZ(),
                             0.25});  // the small of the back
  AddHead(creature);
  AddLegs(creature);
  CreaturePart& tail = AddLimb("tail",
                               {{{0, 1.08, -0.58}, 0.07},
                                {{0, 1.12, -0.84}, 0.062},
                                {{0, 1.0, -1.1}, 0.056},
                                {{0, 0.82, -1.3}, 0.036}},
                               0.05, creature);
  tail.inner_blend = 0.04;
  creature.poses = {{"rest", {}}, Walk(), Gallop(), Graze(), Crouch()};
  return creature;
}

}  // namespace marrow
