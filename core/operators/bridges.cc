#include "core/operators/bridges.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/cancellable.h"
#include "core/base/disjoint_sets.h"
#include "core/mesh/components.h"
#include "core/mesh/unit_box.h"
#include "core/operators/body_tree.h"
#include "core/operators/surface_points.h"

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

// The vertices, and points inside coarse faces for which a corner stands.
class Shells {
 public:
  Shells(const TriangleMesh& mesh, const Positions& places, double near,
         const CancelToken& cancel)
      : Shells(mesh.NumVertices(), places, PointsInFaces(mesh, places, near),
               cancel) {}

  uint32_t NumPoints() const { return static_cast<uint32_t>(vertex_.size()); }
  // `body` of each vertex. To be called before the searches below.
  void SetBodies(const std::vector<uint32_t>& body) {
    body_.resize(vertex_.size());
    for (uint32_t i = 0; i < vertex_.size(); ++i) body_[i] = body[vertex_[i]];
    tree_.SetBodies(body_);
  }
  uint32_t BodyOf(uint32_t point) const { return body_[point]; }
  void Improve(uint32_t point, Candidate& best) const {
    tree_.Improve(point, best);
  }
  // That of the vertices. The lesser first.
  Bridge BridgeOf(const Candidate& candidate) const {
    const auto [a, b] = candidate.ends;
    return {std::min(vertex_[a], vertex_[b]), std::max(vertex_[a], vertex_[b])};
  }

 private:
  Shells(uint32_t vertices, const Positions& places, const FacePoints& inside,
         const CancelToken& cancel)
      : vertex_(vertices), tree_(Together(places, inside.places), cancel) {
    std::iota(vertex_.begin(), vertex_.end(), 0u);
    vertex_.insert(vertex_.end(), inside.corner.begin(), inside.corner.end());
  }

  static Positions Together(const Positions& a, const Positions& b) {
    Positions all(a.rows() + b.rows(), 3);
    all << a, b;
    return all;
  }

  std::vector<uint32_t> vertex_;  // of each point
  std::vector<uint32_t> body_;
  BodyTree tree_;
};

// Every body but the largest looks for its nearest neighbour: the largest is
// found by others, and its many points need not search.
std::vector<Candidate> NearestBodies(const Shells& shells, uint32_t vertices,
                                     double longest_square,
                                     const CancelToken& cancel) {
  std::vector<uint32_t> size(vertices, 0);
  for (uint32_t i = 0; i < shells.NumPoints(); ++i) ++size[shells.BodyOf(i)];
  const uint32_t largest = static_cast<uint32_t>(
      std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<Candidate> best(vertices, {longest_square});
  (void)ForEachIndex(shells.NumPoints(), cancel, [&](uint32_t i) {
    if (shells.BodyOf(i) != largest) shells.Improve(i, best[shells.BodyOf(i)]);
  });
  return best;
}

// Every round joins each body to its nearest, so there are O(log n).
std::vector<Bridge> Span(Shells& shells, DisjointSets sets, uint32_t vertices,
                         uint32_t bodies, double longest_square,
                         const CancelToken& cancel) {
  std::vector<Bridge> bridges;
  for (bool joined = true; joined && bodies > 1 && !cancel.IsCancelled();) {
    joined = false;
    shells.SetBodies(sets.Representatives());
    std::vector<Candidate> best =
        NearestBodies(shells, vertices, longest_square, cancel);
    std::sort(best.begin(), best.end());
    for (const Candidate& candidate : best) {
      if (!candidate.IsBridge()) continue;
      const Bridge bridge = shells.BridgeOf(candidate);
      if (!sets.Union(bridge[0], bridge[1])) continue;
      bridges.push_back(bridge);
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

std::vector<Bridge> SpanningBridges(const TriangleMesh& mesh, double longest,
                                    const CancelToken& cancel) {
  const uint32_t n = mesh.NumVertices();
  DisjointSets sets(n);
  const uint32_t components = JoinCorners(mesh, sets);
  if (components == 1) return {};
  const UnitPoints box = ToUnitBox(mesh);
  longest /= box.unit;
  // Points no farther apart than what they are to bridge.
  Shells shells(mesh, box.points,
                std::min(UnitBridgingDistance(mesh, box.points), longest),
                cancel);
  return Span(shells, sets, n, components, longest * longest, cancel);
}

std::vector<Bridge> FindBridges(const TriangleMesh& mesh,
                                const CancelToken& cancel) {
  const uint32_t n = mesh.NumVertices();
  DisjointSets sets(n);
  const uint32_t components = JoinCorners(mesh, sets);
  if (components == 1) return {};
  const UnitPoints box = ToUnitBox(mesh);
  const double near = UnitBridgingDistance(mesh, box.points);
  Shells shells(mesh, box.points, near, cancel);
  std::vector<Bridge> bridges =
      Span(shells, sets, n, components, std::numeric_limits<double>::infinity(),
           cancel);
  if (cancel.IsCancelled()) return bridges;
  shells.SetBodies(sets.Representatives());
  (void)ForEachIndex(shells.NumPoints(), cancel, [&](uint32_t i) {
    Candidate nearest{near * near};
    shells.Improve(i, nearest);
    if (nearest.IsBridge()) bridges.push_back(shells.BridgeOf(nearest));
  });
  std::sort(bridges.begin(), bridges.end());
  bridges.erase(std::unique(bridges.begin(), bridges.end()), bridges.end());
  return bridges;
}

}  // namespace marrow
