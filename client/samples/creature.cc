#include "client/samples/creature.h"

namespace marrow {
namespace {

// A joint bends over a band a little wider than the limb is thick: narrower,
// and the skin inside a right-angled elbow would fold over itself.
constexpr double kJointWidthPerRadius = 1.6;
constexpr double kRootWidthPerRadius = 1.2;

Eigen::Vector3d DirectionAt(const std::vector<LimbNode>& nodes, size_t i) {
  Eigen::Vector3d ahead =
      (nodes[i + 1].position - nodes[i].position).normalized();
  if (i == 0) return ahead;
  return (ahead + (nodes[i].position - nodes[i - 1].position).normalized())
      .normalized();
}

RoundCone MirrorCone(const RoundCone& cone) {
  return {MirrorPoint(cone.a), MirrorPoint(cone.b), cone.radius_a,
          cone.radius_b};
}

}  // namespace

Eigen::Vector3d MirrorPoint(const Eigen::Vector3d& p) {
  return {-p.x(), p.y(), p.z()};
}

Eigen::Vector3d MirrorTurn(const Eigen::Vector3d& degrees) {
  return {degrees.x(), -degrees.y(), -degrees.z()};
}

CreaturePart& AddLimb(const std::string& name,
                      const std::vector<LimbNode>& nodes, double outer_blend,
                      Creature& creature) {
  const auto part_id = static_cast<uint32_t>(creature.parts.size());
  CreaturePart& part = creature.parts.emplace_back();
  part.name = name;
  part.inner_blend = 0.3 * nodes.back().radius;
  part.outer_blend = outer_blend;
  part.root = nodes.front().position;
  part.root_width = kRootWidthPerRadius * nodes.front().radius;
  for (size_t i = 0; i + 1 < nodes.size(); ++i) {
    part.cones.push_back({nodes[i].position, nodes[i + 1].position,
                          nodes[i].radius, nodes[i + 1].radius});
    creature.joints.push_back({part_id, static_cast<uint32_t>(i),
                               nodes[i].position, DirectionAt(nodes, i),
                               kJointWidthPerRadius * nodes[i].radius});
  }
  return part;
}

void AddLimbPair(const std::string& name, const std::vector<LimbNode>& nodes,
                 const std::vector<RoundCone>& details, double outer_blend,
                 Creature& creature) {
  CreaturePart& left = AddLimb("left_" + name, nodes, outer_blend, creature);
  left.cones.insert(left.cones.end(), details.begin(), details.end());
  std::vector<LimbNode> mirrored = nodes;
  for (LimbNode& node : mirrored) node.position = MirrorPoint(node.position);
  CreaturePart& right =
      AddLimb("right_" + name, mirrored, outer_blend, creature);
  for (const RoundCone& cone : details) {
    right.cones.push_back(MirrorCone(cone));
  }
}

void TurnBoth(const std::string& limb, uint32_t joint,
              const Eigen::Vector3d& degrees, CreaturePose& pose) {
  pose.turns.push_back({"left_" + limb, joint, degrees});
  pose.turns.push_back({"right_" + limb, joint, MirrorTurn(degrees)});
}

}  // namespace marrow
