#include "core/boundaries/boundary_meter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/boundaries/calibration.h"
#include "core/boundaries/loops.h"

namespace marrow {
namespace {

constexpr double kCurvatureLimit = 5;
constexpr double kSaddle = -0.1;
// In units of r.
constexpr double kStripBreadth = 2;
constexpr double kNearWidth = 0.25;
constexpr double kWideWidth = 1;
// Stand for the length, the share or the growth of what has none.
constexpr double kLeastLength = 1e-12;
constexpr double kLeastShare = 1e-12;
constexpr double kLeastGrowth = 0.05;

}  // namespace

double Strength(const Measures& measures) {
  double sum = 0;
  for (uint32_t i = 0; i < kNumMeasures; ++i)
    sum += kStrengthWeights[i] * measures[i];
  return 1 / (1 + std::exp(-sum));
}

BoundaryMeter::BoundaryMeter(const TriangleMesh& mesh,
                             const Adjacency& adjacency,
                             const std::vector<double>& face_areas,
                             const Curvature& curvature)
    : mesh_(mesh),
      adjacency_(adjacency),
      face_areas_(face_areas),
      curvature_(curvature),
      unit_(UnitAreaPositions(mesh)),
      flood_(mesh, adjacency, unit_) {}

Measures BoundaryMeter::MeasureBoundary(const PieceGraph& graph,
                                        const PieceGraph::Pair& groups) {
  Cut cut{graph,
          graph.boundaries().at(groups),
          {groups.first, groups.second},
          0,
          0};
  if (graph.Area(cut.groups[1]) < graph.Area(cut.groups[0]))
    std::swap(cut.groups[0], cut.groups[1]);
  for (uint32_t e : cut.edges) {
    const auto [a, b] = adjacency_.EdgeVertices(e);
    cut.length += EdgeLength(a, b);
  }
  cut.length = std::max(kLeastLength, cut.length);
  cut.radius = cut.length / (2 * std::numbers::pi);
  const double smaller = std::max(kLeastShare, graph.Area(cut.groups[0]));
  const double larger = std::max(kLeastShare, graph.Area(cut.groups[1]));
  const double log_length = std::log(cut.length);

  Measures measures;
  measures[kConstant] = 1;
  measures[kLength] = log_length;
  measures[kRelativeLength] = log_length - 0.5 * std::log(smaller);
  measures[kLargerArea] = std::log(larger);
  std::tie(measures[kCurvatureNear], measures[kSaddleNear]) =
      CurvatureAlong(cut, kNearWidth * cut.radius);
  measures[kSaddleWide] = CurvatureAlong(cut, kWideWidth * cut.radius).second;
  MeasureStrips(cut, measures);
  measures[kLargestLoop] = LargestLoopShare(adjacency_, unit_, cut.edges);
  return measures;
}

double BoundaryMeter::EdgeLength(uint32_t a, uint32_t b) const {
  return (unit_.row(a) - unit_.row(b)).norm();
}

std::pair<double, double> BoundaryMeter::CurvatureAlong(const Cut& cut,
                                                        double width) const {
  double mean = 0, saddle = 0;
  for (uint32_t e : cut.edges) {
    const auto [a, b] = adjacency_.EdgeVertices(e);
    const double K = 0.5 * (curvature_.At(a, width) + curvature_.At(b, width));
    const double scaled = K * cut.radius * cut.radius;
    const double share = EdgeLength(a, b) / cut.length;
    mean += share * std::clamp(scaled, -kCurvatureLimit, kCurvatureLimit);
    if (scaled < kSaddle) saddle += share;
  }
  return {mean, saddle};
}

void BoundaryMeter::MeasureStrips(const Cut& cut, Measures& measures) {
  const std::vector<uint32_t>& group = cut.graph.group_of_face();
  const double breadth = kStripBreadth * cut.radius;
  flood_.Run(cut.edges, breadth, [&](uint32_t f) {
    return group[f] == cut.groups[0] || group[f] == cut.groups[1];
  });
  double areas[2] = {};
  for (uint32_t f : flood_.faces())
    if (flood_.DistanceOf(f) < breadth)
      areas[group[f] == cut.groups[1]] += face_areas_[f];
  auto growth = [&](double area) {
    return std::log(std::max(kLeastGrowth, area / (breadth * cut.length)));
  };
  measures[kStripOfSmaller] = growth(areas[0]);
  measures[kStripOfLarger] = growth(areas[1]);
}

}  // namespace marrow
