#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "client/samples/creature.h"

namespace marrow {
namespace {

using Eigen::Vector3d;

constexpr int kTentacles = 8;
constexpr uint32_t kJoints = 7;

// No tentacle points straight ahead.
double AngleOf(int tentacle) {
  return (tentacle + 0.5) * 2 * M_PI / kTentacles;
}

std::string NameOf(int tentacle) {
  return absl::StrCat("tentacle_", tentacle + 1);
}

Vector3d Outward(int tentacle) {
  return {std::sin(AngleOf(tentacle)), 0, std::cos(AngleOf(tentacle))};
}

// Lifts the tentacle.
Vector3d Lift(int tentacle, double degrees) {
  return degrees *
         Vector3d(-std::cos(AngleOf(tentacle)), 0, std::sin(AngleOf(tentacle)));
}

// Sweeps it sideways, against the clock as seen from above.
Vector3d Sweep(double degrees) { return {0, degrees, 0}; }

CreaturePart Body() {
  CreaturePart body;
  body.name = "body";
  body.inner_blend = 0.12;
  body.cones = {
      {{0, 0.27, 0}, {0, 0.48, 0.02}, 0.4, 0.29},
      {{0, 0.48, 0.02}, {0, 0.95, -0.12}, 0.29, 0.42},
      {{0, 0.95, -0.12}, {0, 1.3, -0.28}, 0.42, 0.3},
      {{-0.2, 0.62, 0.2}, {-0.23, 0.67, 0.26}, 0.1, 0.085},  // eyes
      {{0.2, 0.62, 0.2}, {0.23, 0.67, 0.26}, 0.1, 0.085},
  };
  return body;
}

void AddTentacle(int tentacle, Creature& creature) {
  struct Station {
    double out, up, radius;
  };
  constexpr std::array<Station, kJoints + 1> kStations = {{{0.37, 0.19, 0.07},
                                                           {0.56, 0.13, 0.105},
                                                           {0.76, 0.11, 0.118},
                                                           {0.97, 0.1, 0.11},
                                                           {1.17, 0.09, 0.095},
                                                           {1.36, 0.09, 0.08},
                                                           {1.54, 0.1, 0.065},
                                                           {1.7, 0.12, 0.05}}};
  std::vector<LimbNode> nodes;
  nodes.reserve(kStations.size());
  for (const Station& station : kStations) {
    nodes.push_back(
        {station.out * Outward(tentacle) + station.up * Vector3d::UnitY(),
         station.radius});
  }
  AddLimb(NameOf(tentacle), nodes, 0.03, creature);
  // A tentacle has no elbows: it bends all along.
  for (CreatureJoint& joint : creature.joints) joint.width = 0.22;
}

CreaturePose Curl() {
  CreaturePose pose{"curl", {}};
  for (int i = 0; i < kTentacles; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    pose.turns.push_back({NameOf(i), 0, Lift(i, 8)});
    for (uint32_t joint = 2; joint < kJoints; ++joint) {
      pose.turns.push_back({NameOf(i), joint, Lift(i, 15 + 4.5 * joint)});
      pose.turns.push_back({NameOf(i), joint, Sweep(side * 7)});
    }
  }
  return pose;
}

CreaturePose Crawl() {
  CreaturePose pose{"crawl", {}};
  for (int i = 0; i < kTentacles; ++i) {
    for (uint32_t joint = 1; joint < kJoints; ++joint) {
      // All wind alike, so that neighbours stay clear of each other.
      const double phase = 1.15 * joint + 0.3 * i;
      pose.turns.push_back({NameOf(i), joint, Sweep(36 * std::sin(phase))});
    }
    pose.turns.push_back({NameOf(i), 0, Lift(i, i % 2 == 0 ? 6 : -3)});
  }
  return pose;
}

CreaturePose Swim() {
  CreaturePose pose{"swim", {}};
  for (int i = 0; i < kTentacles; ++i) {
    pose.turns.push_back({NameOf(i), 0, Lift(i, -22)});
    for (uint32_t joint = 1; joint < 4; ++joint) {
      pose.turns.push_back({NameOf(i), joint, Lift(i, -14)});
    }
    for (uint32_t joint = 4; joint < kJoints; ++joint) {
      pose.turns.push_back({NameOf(i), joint, Lift(i, 18)});
    }
  }
  return pose;
}

CreaturePose Reach() {
  CreaturePose pose{"reach", {}};
  for (int i = 0; i < kTentacles; ++i) {
    const bool in_front = Outward(i).z() > 0.5;
    const double side = Outward(i).x() > 0 ? 1 : -1;
    for (uint32_t joint = 0; joint < kJoints; ++joint) {
      const double lift = joint < 3 ? 19 : -12;
      pose.turns.push_back(
          {NameOf(i), joint,
           in_front ? Lift(i, lift) : Sweep(side * (joint < 4 ? -4 : 20))});
    }
  }
  return pose;
}

}  // namespace

Creature MakeOctopus() {
  Creature creature;
  creature.name = "octopus";
  creature.description = "an octopus with eight tentacles";
  creature.parts.push_back(Body());
  for (int i = 0; i < kTentacles; ++i) AddTentacle(i, creature);
  creature.poses = {{"rest", {}}, Crawl(), Curl(), Swim(), Reach()};
  return creature;
}

}  // namespace marrow
