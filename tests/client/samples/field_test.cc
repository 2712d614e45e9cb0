#include "client/samples/field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace marrow {
namespace {

using Eigen::Vector3d;

// One cone from (0, 0, 0), radius 0.5, to (0, 2, 0), radius 0.2, and a limb
// that sticks out of its side.
Creature ConeWithLimb() {
  Creature creature;
  CreaturePart body;
  body.name = "body";
  body.cones = {{{0, 0, 0}, {0, 2, 0}, 0.5, 0.2}};
  creature.parts.push_back(body);
  AddLimb("limb", {{{0.2, 1, 0}, 0.1}, {{1.5, 1, 0}, 0.1}}, 0.1, creature);
  return creature;
}

// The union of many spheres along the axis, taken one by one.
double DistanceBySpheres(const RoundCone& cone, const Vector3d& p) {
  double least = 1e9;
  constexpr int kSpheres = 20000;
  for (int i = 0; i <= kSpheres; ++i) {
    const double t = static_cast<double>(i) / kSpheres;
    const Vector3d centre = (1 - t) * cone.a + t * cone.b;
    const double radius = (1 - t) * cone.radius_a + t * cone.radius_b;
    least = std::min(least, (p - centre).norm() - radius);
  }
  return least;
}

TEST(CreatureFieldTest, MeasuresARoundConeAsTheSpheresItIsMadeOf) {
  const Creature creature = ConeWithLimb();
  const CreatureField field(creature);
  for (const Vector3d& p : {Vector3d(0.9, 0.7, 0.1), Vector3d(-0.4, 2.3, 0.2),
                            Vector3d(0.1, -0.8, 0.3), Vector3d(-0.1, 1.2, 0.05),
                            Vector3d(0, 1, 0.6)}) {
    EXPECT_NEAR(field.PartDistances(p)[0],
                DistanceBySpheres(creature.parts[0].cones[0], p), 1e-6);
  }
}

TEST(CreatureFieldTest, HasTheGradientOfItsValues) {
  const Creature creature = ConeWithLimb();
  const CreatureField field(creature);
  constexpr double kStep = 1e-6;
  for (const Vector3d& p : {Vector3d(0.5, 1.13, 0.02), Vector3d(0.45, 1.1, 0.1),
                            Vector3d(0.2, -0.6, 0.3), Vector3d(1, 1.2, 0.1)}) {
    const FieldSample sample = field.At(p);
    for (int i = 0; i < 3; ++i) {
      const Vector3d step = kStep * Vector3d::Unit(i);
      const double slope =
          (field.At(p + step).value - field.At(p - step).value) / (2 * kStep);
      EXPECT_NEAR(sample.gradient[i], slope, 1e-5);
    }
    EXPECT_LE(sample.gradient.norm(), 1 + 1e-9);
  }
}

TEST(CreatureFieldTest, FilletsWhereALimbMeetsTheBodyAndNowhereElse) {
  const Creature creature = ConeWithLimb();
  const CreatureField field(creature);
  const auto lesser_part = [&](const Vector3d& p) {
    const std::vector<double> distances = field.PartDistances(p);
    return *std::min_element(distances.begin(), distances.end());
  };
  const Vector3d crease(0.37, 1.12, 0);
  EXPECT_LT(field.At(crease).value, lesser_part(crease) - 0.01);
  for (const Vector3d& p : {Vector3d(1.2, 1.1, 0), Vector3d(0, -0.5, 0)}) {
    EXPECT_EQ(field.At(p).value, lesser_part(p));
  }
}

TEST(CreatureFieldTest, KnowsTheThicknessNearby) {
  const Creature creature = ConeWithLimb();
  const CreatureField field(creature);
  EXPECT_NEAR(field.LocalRadius({1.2, 1.1, 0}), 0.1, 1e-12);
  EXPECT_NEAR(field.LocalRadius({-1, 1, 0}), 0.35, 1e-12);
}

}  // namespace
}  // namespace marrow
