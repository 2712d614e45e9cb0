// Poses of points on a creature's skin.
#ifndef MARROW_CLIENT_SAMPLES_POSE_H_
#define MARROW_CLIENT_SAMPLES_POSE_H_

#include <Eigen/Core>
#include <vector>

#include "client/samples/creature.h"
#include "client/samples/field.h"

namespace marrow {

// Where points of the rest pose are in `pose`. Bent skin keeps its lengths as
// well as bent skin can: each joint turns a point by a share of its angle
// that grows smoothly along the limb, instead of mixing turned positions.
std::vector<Eigen::Vector3d> PosePoints(
    const Creature& creature, const CreatureField& field,
    const CreaturePose& pose, const std::vector<Eigen::Vector3d>& points);

}  // namespace marrow

#endif  // MARROW_CLIENT_SAMPLES_POSE_H_
