// A creature as numbers: round cones that make its surface, parts that own
// the cones, joints that bend it and the poses it can take.
//
// Coordinates: y is up, the creature looks along +z, its left is +x. A length
// of 1 is about half a creature.
#ifndef MARROW_CLIENT_SAMPLES_CREATURE_H_
#define MARROW_CLIENT_SAMPLES_CREATURE_H_

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace marrow {

// The convex hull of two spheres.
struct RoundCone {
  Eigen::Vector3d a, b;
  double radius_a, radius_b;
};

// A node of a limb's middle line.
struct LimbNode {
  Eigen::Vector3d position;
  double radius;
};

// Part 0 is the body; every other part is a limb that grows out of it.
struct CreaturePart {
  std::string name;
  std::vector<RoundCone> cones;
  double inner_blend = 0;  // width of the fillets among the part's cones
  double outer_blend = 0;  // width of the fillet where the limb meets the body
  double root_width = 0;   // half the band over which the limb's root bends
  Eigen::Vector3d root = Eigen::Vector3d::Zero();  // where the limb begins
};

// Points of `part` beyond the plane through `pivot` with normal `along` turn
// with the joint; within `width` of the plane they turn by a share of it.
// Joint 0 of a limb turns the whole limb.
struct CreatureJoint {
  uint32_t part;
  uint32_t index;
  Eigen::Vector3d pivot;
  Eigen::Vector3d along;
  double width;
};

// A turn of one joint about an axis in the rest pose's frame; the vector's
// length is the angle in degrees. Turns of one joint compose in their order.
struct JointTurn {
  std::string part;
  uint32_t joint;
  Eigen::Vector3d degrees;
};

struct CreaturePose {
  std::string name;
  std::vector<JointTurn> turns;
};

struct Creature {
  std::string name;
  std::string description;
  std::vector<CreaturePart> parts;
  std::vector<CreatureJoint> joints;  // a joint comes before those it carries
  std::vector<CreaturePose> poses;    // the first is "rest", without turns
};

// The reflection that swaps left and right: of a place, and of a turn.
Eigen::Vector3d MirrorPoint(const Eigen::Vector3d& p);
Eigen::Vector3d MirrorTurn(const Eigen::Vector3d& degrees);

// Appends a limb along `nodes`, with a joint at every node but the last.
// Returns the new part, valid until the next is added.
CreaturePart& AddLimb(const std::string& name,
                      const std::vector<LimbNode>& nodes, double outer_blend,
                      Creature& creature);

// Appends "left_" + name along `nodes` and its mirror image "right_" + name.
// `details` are further cones of the left one.
void AddLimbPair(const std::string& name, const std::vector<LimbNode>& nodes,
                 const std::vector<RoundCone>& details, double outer_blend,
                 Creature& creature);

// Turns of "left_" + limb and, mirrored, of "right_" + limb.
void TurnBoth(const std::string& limb, uint32_t joint,
              const Eigen::Vector3d& degrees, CreaturePose& pose);

Creature MakeHumanoid();
Creature MakeQuadruped();
Creature MakeHand();
Creature MakeOctopus();

}  // namespace marrow

#endif  // MARROW_CLIENT_SAMPLES_CREATURE_H_
