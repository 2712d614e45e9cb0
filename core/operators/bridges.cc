#include "core/operators/bridges.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/mesh/components.h"
#include "core/mesh/unit_box.h"
#include "core/operators/body_tree.h"

namespace marrow {
namespace {

double MeanEdge(const TriangleMesh& mesh, const Positions& points) {
  double sum = 0;
  for (const Triangle& face : mesh.faces)
    for (int i = 0; i < 3; ++i)
      sum += (points.row(face[i]) - points.row(face[(i + 1) % 3])).norm();
  return sum / (3.0 * mesh.NumFaces());
}

double UnitBridgingDistance(const TriangleMesh& mesh, const Positions& points) {
  constexpr double kLeast = 0.01, kMost = 0.03;
  const double diagonal =
      (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  return std::clamp(MeanEdge(mesh, points), kLeast * diagonal,
                    kMost * diagonal);
}

// Every body but the largest looks for its nearest neighbour: the largest is
// found by others, and its many vertices need not search.
std::vector<Candidate> NearestBodies(const BodyTree& tree,
                                     const std::vector<uint32_t>& body,
                                     double longest_square) {
  const uint32_t n = static_cast<uint32_t>(body.size());
  std::vector<uint32_t> size(n, 0);
  for (uint32_t b : body) ++size[b];
  const uint32_t largest = static_cast<uint32_t>(
      std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<Candidate> best(n, {longest_square});
  for (uint32_t v = 0; v < n; ++v)
    if (body[v] != largest) tree.Improve(v, best[body[v]]);
  return best;
}

// Every round joins each body to its nearest, so there are O(log n).
std::vector<Bridge> Span(BodyTree& tree, DisjointSets sets, uint32_t bodies,
                         double longest_square) {
  std::vector<Bridge> bridges;
  for (bool joined = true; joined && bodies > 1;) {
    joined = false;
    const std::vector<uint32_t> body = sets.Representatives();
    tree.SetBodies(body);
    std::vector<Candidate> best = NearestBodies(tree, body, longest_square);
    std::sort(best.begin(), best.end());
    for (const Candidate& candidate : best) {
      if (!candidate.IsBridge()) continue;
      if (!sets.Union(candidate.ends[0], candidate.ends[1])) continue;
      bridges.push_back(candidate.ends);
      --bodies;
      joined = true;
    }
  }
  std::sort(bridges.begin(), bridges.end());
  return bridges;
}

}  // namespace

double BridgingDistance(const TriangleMesh& mesh) {
  const UnitPoints box = ToUnitBox(mesh);
  return box.unit * UnitBridgingDistance(mesh, box.points);
}

std::vector<Bridge> SpanningBridges(const TriangleMesh& mesh, double longest) {
  const uint32_t n = mesh.NumVertices();
  DisjointSets sets(n);
  const uint32_t components = JoinCorners(mesh, sets);
  if (components == 1) return {};
  UnitPoints box = ToUnitBox(mesh);
  longest /= box.unit;
  BodyTree tree(std::move(box.points));
  return Span(tree, sets, components, longest * longest);
}

std::vector<Bridge> FindBridges(const TriangleMesh& mesh) {
  const uint32_t n = mesh.NumVertices();
  DisjointSets sets(n);
  const uint32_t components = JoinCorners(mesh, sets);
  if (components == 1) return {};
  UnitPoints box = ToUnitBox(mesh);
  const double near = UnitBridgingDistance(mesh, box.points);
  BodyTree tree(std::move(box.points));
  std::vector<Bridge> bridges =
      Span(tree, sets, components, std::numeric_limits<double>::infinity());
  const std::vector<uint32_t> component = sets.Representatives();
  tree.SetBodies(component);
  for (uint32_t v = 0; v < n; ++v) {
    Candidate nearest{near * near};
    tree.Improve(v, nearest);
    if (nearest.IsBridge()) bridges.push_back(nearest.ends);
  }
  std::sort(bridges.begin(), bridges.end());
  bridges.erase(std::unique(bridges.begin(), bridges.end()), bridges.end());
  return bridges;
}

}  // namespace marrow
