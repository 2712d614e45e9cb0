#include "core/boundaries/boundary_meter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/boundaries/calibration.h"
#include "core/boundaries/loops.h"
#include "core/mesh/rims.h"

namespace marrow {
namespace {

// Of K r^2: what is half a saddle, and how soon more of it is a whole one.
constexpr double kSaddle = -0.1;
constexpr double kSaddleSpread = 0.15;
// In units of r.
constexpr double kStripBreadth = 2;
constexpr double kNearWidth = 0.25;
constexpr double kMiddleWidth = 0.5;
constexpr double kWideWidth = 1;
// Stand for the length, the share or the growth of what has none.
constexpr double kLeastLength = 1e-12;
constexpr double kLeastShare = 1e-12;
constexpr double kLeastGrowth = 0.05;

double Logistic(double x) { return 1 / (1 + std::exp(-x)); }
double LogOdds(double p) { return std::log(p / (1 - p)); }

// Grows with `strength`, on the same side of kAutomaticSalience.
double Ranked(double strength, double apart) {
  if (strength <= kAutomaticSalience) return strength;
  const double automatic = LogOdds(kAutomaticSalience);
  const double beyond = LogOdds(strength) - automatic;
  const double first =
      beyond + std::min((kFirstSplitGain - 1) * beyond, kFirstSplitLead);
  const double share =
      std::clamp((apart - kTogether) / (kApart - kTogether), 0.0, 1.0);
  return Logistic(automatic + share * first +
                  (1 - share) * kLaterSplitGain * beyond);
}

}  // namespace

double Strength(const Measures& measures) {
  double sum = 0;
  for (uint32_t i = 0; i < kNumMeasures; ++i)
    sum += kStrengthWeights[i] * measures[i];
  return Logistic(sum);
}

BoundaryMeter::BoundaryMeter(const TriangleMesh& mesh,
                             const Adjacency& adjacency,
                             const std::vector<double>& face_areas,
                             const Curvature& curvature, double share)
    : mesh_(mesh),
      adjacency_(adjacency),
      face_areas_(face_areas),
      curvature_(curvature),
      share_(share),
      unit_(UnitAreaPositions(mesh)),
      rim_of_vertex_(RimOfVertices(adjacency)),
      flood_(mesh, adjacency, unit_) {}

double BoundaryMeter::StrengthBetween(const PieceGraph& graph,
                                      const PieceGraph::Pair& groups) {
  const auto boundary = graph.boundaries().find(groups);
  if (boundary == graph.boundaries().end() || boundary->second.empty())
    return AsPart(std::min(graph.AreaOfShells(groups.first),
                           graph.AreaOfShells(groups.second)),
                  kShellShare);
  const double strength =
      Strength(MeasureBoundary(graph, groups)) *
      AsPart(std::min(graph.Area(groups.first), graph.Area(groups.second)),
             kSpeckShare);
  return Ranked(strength, graph.ApartInFirstSplit(groups));
}

double BoundaryMeter::AsPart(double area, double half) const {
  const double share = std::max(kLeastShare, share_ * area);
  return 1 / (1 + std::pow(half / share, 2));
}

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
  measures[kSaddleNear] = SaddleAlong(cut, kNearWidth * cut.radius);
  measures[kSaddleMiddle] = SaddleAlong(cut, kMiddleWidth * cut.radius);
  measures[kSaddleWide] = SaddleAlong(cut, kWideWidth * cut.radius);
  MeasureStrips(cut, measures);
  measures[kLargestLoop] =
      LargestLoopShare(adjacency_, unit_, rim_of_vertex_, cut.edges);
  return measures;
}

double BoundaryMeter::EdgeLength(uint32_t a, uint32_t b) const {
  return (unit_.row(a) - unit_.row(b)).norm();
}

double BoundaryMeter::SaddleAlong(const Cut& cut, double width) const {
  double saddle = 0;
  for (uint32_t e : cut.edges) {
    const auto [a, b] = adjacency_.EdgeVertices(e);
    const double K = 0.5 * (curvature_.At(a, width) + curvature_.At(b, width));
    const double scaled = K * cut.radius * cut.radius;
    saddle += EdgeLength(a, b) * Logistic((kSaddle - scaled) / kSaddleSpread);
  }
  return saddle / cut.length;
}

void BoundaryMeter::MeasureStrips(const Cut& cut, Measures& measures) {
  const std::vector<uint32_t>& group = cut.graph.group_of_face();
  const double breadth = kStripBreadth * cut.radius;
  flood_.Run(cut.edges, breadth, [&](uint32_t f) {
    return group[f] == cut.groups[0] || group[f] == cut.groups[1];
  });
  double areas[2] = {};
  for (uint32_t f : flood_.faces())
    areas[group[f] == cut.groups[1]] +=
        face_areas_[f] * flood_.ShareWithin(f, breadth);
  auto growth = [&](double area) {
    return std::log(std::max(kLeastGrowth, area / (breadth * cut.length)));
  };
  measures[kStripOfSmaller] = growth(areas[0]);
  measures[kStripOfLarger] = growth(areas[1]);
}

}  // namespace marrow
