// The creature's surface as the zero set of a distance-like field.
#ifndef MARROW_CLIENT_SAMPLES_FIELD_H_
#define MARROW_CLIENT_SAMPLES_FIELD_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "client/samples/creature.h"

namespace marrow {

// Negative inside. The gradient is at most 1 long: nowhere does the value
// change faster than the distance walked.
struct FieldSample {
  double value;
  Eigen::Vector3d gradient;
};

// Immutable, so any thread may ask. Keeps a reference to the creature.
class CreatureField {
 public:
  explicit CreatureField(const Creature& creature);

  FieldSample At(const Eigen::Vector3d& p) const;

  // The distance of `p` to the surface of every part alone.
  std::vector<double> PartDistances(const Eigen::Vector3d& p) const;

  // The thickness of the cone nearest to `p`, as a radius.
  double LocalRadius(const Eigen::Vector3d& p) const;

  // Holds the surface, with a margin.
  const Eigen::AlignedBox3d& bounds() const { return bounds_; }

 private:
  struct Ball {
    Eigen::Vector3d centre;
    double radius;
  };

  const Creature& creature_;
  std::vector<Ball> part_balls_;  // each holds the part it stands for
  Eigen::AlignedBox3d bounds_;
};

}  // namespace marrow

#endif  // MARROW_CLIENT_SAMPLES_FIELD_H_
