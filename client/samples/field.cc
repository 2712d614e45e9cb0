#include "client/samples/field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace marrow {
namespace {

constexpr double kFar = std::numeric_limits<double>::max();

FieldSample SphereAt(const Eigen::Vector3d& centre, double radius,
                     const Eigen::Vector3d& p) {
  const Eigen::Vector3d from = p - centre;
  const double distance = from.norm();
  if (distance < 1e-12) return {-radius, Eigen::Vector3d::UnitY()};
  return {distance - radius, from / distance};
}

// In the plane of the axis and p, the cone's outline is an arc about a, the
// common tangent of the two circles and an arc about b. How far p lies along
// the tangent says which of the three is nearest.
FieldSample ConeAt(const RoundCone& cone, const Eigen::Vector3d& p) {
  const Eigen::Vector3d axis = cone.b - cone.a;
  const double length = axis.norm();
  const double slope = (cone.radius_a - cone.radius_b) / length;
  if (!(std::abs(slope) < 1)) {
    return cone.radius_a > cone.radius_b ? SphereAt(cone.a, cone.radius_a, p)
                                         : SphereAt(cone.b, cone.radius_b, p);
  }
  const Eigen::Vector3d along = axis / length;
  const double height = (p - cone.a).dot(along);
  const Eigen::Vector3d across = p - cone.a - height * along;
  const double away = across.norm();
  const double cosine = std::sqrt(1 - slope * slope);
  const double on_tangent = height * cosine - away * slope;
  if (on_tangent <= 0) return SphereAt(cone.a, cone.radius_a, p);
  if (on_tangent >= length * cosine) return SphereAt(cone.b, cone.radius_b, p);
  const Eigen::Vector3d outward =
      away > 1e-12 ? Eigen::Vector3d(across / away) : along.unitOrthogonal();
  return {height * slope + away * cosine - cone.radius_a,
          slope * along + cosine * outward};
}

// The union of two fields with a fillet where they differ by less than
// `blend`; elsewhere exactly the lesser.
FieldSample SmoothUnion(const FieldSample& x, const FieldSample& y,
                        double blend) {
  const FieldSample& lesser = x.value <= y.value ? x : y;
  const FieldSample& greater = x.value <= y.value ? y : x;
  const double gap = greater.value - lesser.value;
  if (gap >= blend) return lesser;
  const double share = (blend - gap) / (2 * blend);
  return {lesser.value - blend * share * share,
          (1 - share) * lesser.gradient + share * greater.gradient};
}

FieldSample PartAt(const CreaturePart& part, const Eigen::Vector3d& p) {
  FieldSample sample = ConeAt(part.cones.front(), p);
  for (size_t i = 1; i < part.cones.size(); ++i) {
    sample = SmoothUnion(sample, ConeAt(part.cones[i], p), part.inner_blend);
  }
  return sample;
}

Eigen::AlignedBox3d BoundsOf(const CreaturePart& part) {
  Eigen::AlignedBox3d box;
  for (const RoundCone& cone : part.cones) {
    const double r = std::max(cone.radius_a, cone.radius_b) + part.inner_blend;
    for (const Eigen::Vector3d& end : {cone.a, cone.b}) {
      box.extend(end - Eigen::Vector3d::Constant(r));
      box.extend(end + Eigen::Vector3d::Constant(r));
    }
  }
  return box;
}

}  // namespace

CreatureField::CreatureField(const Creature& creature) : creature_(creature) {
  for (const CreaturePart& part : creature.parts) {
    const Eigen::AlignedBox3d box = BoundsOf(part);
    part_balls_.push_back({box.center(), 0.5 * box.diagonal().norm()});
    bounds_.extend(box);
  }
}

FieldSample CreatureField::At(const Eigen::Vector3d& p) const {
  FieldSample sample = PartAt(creature_.parts.front(), p);
  for (size_t i = 1; i < creature_.parts.size(); ++i) {
    const CreaturePart& part = creature_.parts[i];
    const Ball& ball = part_balls_[i];
    const double at_least = (p - ball.centre).norm() - ball.radius;
    // A part farther than the fillet reaches cannot change the union.
    if (at_least >= sample.value + part.outer_blend) continue;
    sample = SmoothUnion(sample, PartAt(part, p), part.outer_blend);
  }
  return sample;
}

std::vector<double> CreatureField::PartDistances(
    const Eigen::Vector3d& p) const {
  std::vector<double> distances;
  distances.reserve(creature_.parts.size());
  for (const CreaturePart& part : creature_.parts) {
    distances.push_back(PartAt(part, p).value);
  }
  return distances;
}

double CreatureField::LocalRadius(const Eigen::Vector3d& p) const {
  double nearest = kFar;
  double radius = 0;
  for (const CreaturePart& part : creature_.parts) {
    for (const RoundCone& cone : part.cones) {
      const double distance = ConeAt(cone, p).value;
      if (distance >= nearest) continue;
      nearest = distance;
      const Eigen::Vector3d axis = cone.b - cone.a;
      const double share = std::clamp(
          (p - cone.a).dot(axis) / std::max(axis.squaredNorm(), 1e-12), 0., 1.);
      radius = cone.radius_a + share * (cone.radius_b - cone.radius_a);
    }
  }
  return radius;
}

}  // namespace marrow
