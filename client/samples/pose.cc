#include "client/samples/pose.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace marrow {
namespace {

// From 0 at -1 to 1 at 1.
double SmoothStep(double x) {
  const double t = std::clamp(0.5 * (x + 1), 0., 1.);
  return t * t * (3 - 2 * t);
}

// How far each part owns a point: 1 on a limb, 0 off it, between the two in
// the band about the limb's root. The body's is not used.
std::vector<double> Ownership(const Creature& creature,
                              const std::vector<double>& distances) {
  std::vector<double> result(distances.size(), 0);
  for (size_t i = 1; i < distances.size(); ++i) {
    double others = std::numeric_limits<double>::max();
    for (size_t j = 0; j < distances.size(); ++j) {
      if (j != i) others = std::min(others, distances[j]);
    }
    result[i] =
        SmoothStep((others - distances[i]) / creature.parts[i].root_width);
  }
  return result;
}

double BeyondPlane(const CreatureJoint& joint, const Eigen::Vector3d& p) {
  return SmoothStep((p - joint.pivot).dot(joint.along) / joint.width);
}

// The share of the joint's angle by which `p` turns. A limb follows the
// body's joints as its root does, wherever its other end may be.
double ShareOf(const Creature& creature, const CreatureJoint& joint,
               const std::vector<double>& ownership, const Eigen::Vector3d& p) {
  if (joint.part != 0) {
    const double owned = ownership[joint.part];
    return joint.index == 0 || owned == 0 ? owned
                                          : owned * BeyondPlane(joint, p);
  }
  double share = BeyondPlane(joint, p);
  for (size_t i = 1; i < ownership.size(); ++i) {
    if (ownership[i] == 0) continue;
    const double at_root = BeyondPlane(joint, creature.parts[i].root);
    share += ownership[i] * (at_root - share);
  }
  return share;
}

// The turn of every joint, an axis times an angle in radians.
std::vector<Eigen::Vector3d> TurnsOf(const Creature& creature,
                                     const CreaturePose& pose) {
  std::vector<Eigen::Vector3d> result;
  for (const CreatureJoint& joint : creature.joints) {
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    for (const JointTurn& part : pose.turns) {
      if (part.joint != joint.index) continue;
      if (part.part != creature.parts[joint.part].name) continue;
      const double radians = part.degrees.norm() * M_PI / 180;
      turn = Eigen::Quaterniond(
                 Eigen::AngleAxisd(radians, part.degrees.normalized())) *
             turn;
    }
    const Eigen::AngleAxisd whole(turn);
    result.push_back(whole.angle() * whole.axis());
  }
  return result;
}

}  // namespace

std::vector<Eigen::Vector3d> PosePoints(
    const Creature& creature, const CreatureField& field,
    const CreaturePose& pose, const std::vector<Eigen::Vector3d>& points) {
  if (pose.turns.empty()) return points;
  const std::vector<Eigen::Vector3d> turns = TurnsOf(creature, pose);
  std::vector<Eigen::Vector3d> result = points;
  for (size_t v = 0; v < points.size(); ++v) {
    const std::vector<double> ownership =
        Ownership(creature, field.PartDistances(points[v]));
    // Outer joints first: the turns of the inner ones then carry them along.
    for (size_t j = creature.joints.size(); j-- > 0;) {
      if (turns[j].isZero()) continue;
      const CreatureJoint& joint = creature.joints[j];
      const double share = ShareOf(creature, joint, ownership, points[v]);
      if (share == 0) continue;
      const Eigen::AngleAxisd turn(share * turns[j].norm(),
                                   turns[j].normalized());
      result[v] = joint.pivot + turn * (result[v] - joint.pivot);
    }
  }
  return result;
}

}  // namespace marrow
