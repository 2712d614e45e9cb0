#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "client/samples/creature.h"

namespace marrow {
namespace {

using Eigen::Vector3d;

// A right hand with its palm to the front and its fingers up; the thumb is
// on the side of +x.
struct Finger {
  const char* name;
  Vector3d knuckle;
  double fan;     // degrees from straight up towards the thumb
  double length;  // from knuckle to tip
  double radius;  // at the knuckle

  Vector3d Line() const {
    const double angle = fan * M_PI / 180;
    return {std::sin(angle), std::cos(angle), 0};
  }
  // Turns the finger towards the palm.
  Vector3d Curl(double degrees) const {
    return degrees * Line().cross(Vector3d::UnitZ());
  }
};

const std::array<Finger, 4>& Fingers() {
  static const std::array<Finger, 4> fingers = {{
      {"index", {0.31, 0.42, 0}, 13, 0.78, 0.098},
      {"middle", {0.08, 0.48, 0}, 2, 0.88, 0.1},
      {"ring", {-0.145, 0.43, 0}, -8, 0.8, 0.095},
      {"little", {-0.35, 0.31, 0}, -21, 0.62, 0.083},
  }};
  return fingers;
}

// The bend of the thumb's joints, across the palm.
Vector3d ThumbBend(double degrees) {
  return degrees * Vector3d(-0.62, 0.78, 0).normalized() * -1;
}

CreaturePart Palm() {
  CreaturePart palm;
  palm.name = "palm";
  palm.inner_blend = 0.1;
  for (const Finger& finger : Fingers()) {
    palm.cones.push_back({{0.45 * finger.knuckle.x(), -0.4, 0},
                          finger.knuckle - 0.08 * finger.Line(),
                          0.16,
                          finger.radius + 0.035});
  }
  palm.cones.push_back(
      {{0.2, -0.36, 0.05}, {0.3, -0.1, 0.03}, 0.15, 0.13});  // the thumb's ball
  palm.cones.push_back({{-0.08, -1.0, 0}, {-0.07, -0.5, 0}, 0.16, 0.145});
  palm.cones.push_back({{0.08, -1.0, 0}, {0.07, -0.5, 0}, 0.16, 0.145});
  return palm;
}

void AddFinger(const Finger& finger, Creature& creature) {
  const auto at = [&](double share) -> Vector3d {
    return finger.knuckle + share * finger.length * finger.Line();
  };
  AddLimb(finger.name,
          {{at(0), finger.radius},
           {at(0.47), 0.92 * finger.radius},
           {at(0.76), 0.86 * finger.radius},
           {at(0.97), 0.72 * finger.radius}},
          0.05, creature);
}

void CurlFinger(const Finger& finger, double knuckle, double middle, double tip,
                CreaturePose& pose) {
  pose.turns.push_back({finger.name, 0, finger.Curl(knuckle)});
  pose.turns.push_back({finger.name, 1, finger.Curl(middle)});
  pose.turns.push_back({finger.name, 2, finger.Curl(tip)});
}

void BendThumb(double root, double middle, double tip, CreaturePose& pose) {
  pose.turns.push_back({"thumb", 0, ThumbBend(root)});
  pose.turns.push_back({"thumb", 1, ThumbBend(middle)});
  pose.turns.push_back({"thumb", 2, ThumbBend(tip)});
}

CreaturePose Grasp() {
  CreaturePose pose{"grasp", {}};
  for (const Finger& finger : Fingers()) CurlFinger(finger, 42, 48, 30, pose);
  BendThumb(20, 22, 25, pose);
  return pose;
}

CreaturePose Point() {
  CreaturePose pose{"point", {}};
  CurlFinger(Fingers()[0], 6, 6, 4, pose);
  for (size_t i = 1; i < 4; ++i) CurlFinger(Fingers()[i], 62, 76, 42, pose);
  BendThumb(15, 25, 30, pose);
  return pose;
}

CreaturePose Victory() {
  CreaturePose pose{"victory", {}};
  CurlFinger(Fingers()[0], 4, 4, 3, pose);
  CurlFinger(Fingers()[1], 4, 4, 3, pose);
  pose.turns.push_back({"middle", 0, {0, 0, 6}});
  for (size_t i = 2; i < 4; ++i) CurlFinger(Fingers()[i], 60, 74, 42, pose);
  BendThumb(30, 30, 30, pose);
  return pose;
}

CreaturePose Spread() {
  CreaturePose pose{"spread", {}};
  const std::array<double, 4> fan = {-10, -2, 6, 14};
  for (size_t i = 0; i < 4; ++i) {
    pose.turns.push_back({Fingers()[i].name, 0, {0, 0, fan[i]}});
    CurlFinger(Fingers()[i], -12, 4, 4, pose);
  }
  pose.turns.push_back({"thumb", 0, {0, 0, -16}});
  return pose;
}

}  // namespace

Creature MakeHand() {
  Creature creature;
  creature.name = "hand";
  creature.description = "a hand with five fingers and the wrist";
  creature.parts.push_back(Palm());
  for (const Finger& finger : Fingers()) AddFinger(finger, creature);
  AddLimb("thumb",
          {{{0.34, -0.12, 0.04}, 0.115},
           {{0.58, 0.1, 0.07}, 0.105},
           {{0.74, 0.3, 0.08}, 0.095},
           {{0.83, 0.47, 0.08}, 0.075}},
          0.1, creature);
  creature.poses = {{"rest", {}}, Grasp(), Point(), Victory(), Spread()};
  return creature;
}

}  // namespace marrow
