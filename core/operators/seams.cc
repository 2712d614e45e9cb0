#include "core/operators/seams.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "core/base/cancellable.h"
#include "core/base/disjoint_sets.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/components.h"
#include "core/mesh/rims.h"
#include "core/mesh/unit_box.h"
#include "core/mesh/vertex_cloud.h"
#include "core/operators/body_tree.h"

namespace marrow {
namespace {

// For each of the rim's vertices the place in `rim` of the nearest one of
// another component; its own place where there is none.
absl::StatusOr<std::vector<uint32_t>> NearestAcross(
    const TriangleMesh& mesh, const std::vector<uint32_t>& rim,
    const std::vector<uint32_t>& component, double longest,
    const CancelToken& cancel) {
  const UnitPoints box = ToUnitBox(mesh);
  Positions points(rim.size(), 3);
  std::vector<uint32_t> body(rim.size());
  for (size_t i = 0; i < rim.size(); ++i) {
    points.row(i) = box.points.row(rim[i]);
    body[i] = component[rim[i]];
  }
  BodyTree tree(std::move(points), cancel);
  tree.SetBodies(body);
  const double reach = longest / box.unit;
  std::vector<uint32_t> across(rim.size());
  MARROW_RETURN_IF_ERROR(ForEachIndex(rim.size(), cancel, [&](uint32_t i) {
    Candidate nearest{reach * reach};
    tree.Improve(i, nearest);
    across[i] = !nearest.IsBridge()    ? i
                : nearest.ends[0] == i ? nearest.ends[1]
                                       : nearest.ends[0];
  }));
  return across;
}

// More meet in no vertex of a surface; sets that grow without end would cost
// the square of their size.
constexpr size_t kMostShells = 256;

// Sets of vertices of which no two are of one component: else a face could be
// lost, or a component grow together with itself.
class Seams {
 public:
  explicit Seams(const std::vector<uint32_t>& component)
      : component_(component), sets_(component.size()) {}

  // Unless one component would be there twice, as when they are one already.
  void Sew(uint32_t u, uint32_t v) {
    std::vector<uint32_t> joined = ComponentsOf(u);
    for (uint32_t c : ComponentsOf(v)) joined.push_back(c);
    std::sort(joined.begin(), joined.end());
    if (joined.size() > kMostShells ||
        std::adjacent_find(joined.begin(), joined.end()) != joined.end())
      return;
    sets_.Union(u, v);
    components_[sets_.Find(u)] = std::move(joined);
  }
  std::vector<uint32_t> Representatives() { return sets_.Representatives(); }

 private:
  std::vector<uint32_t> ComponentsOf(uint32_t v) {
    const auto it = components_.find(sets_.Find(v));
    return it == components_.end() ? std::vector<uint32_t>{component_[v]}
                                   : it->second;
  }

  const std::vector<uint32_t>& component_;
  DisjointSets sets_;
  absl::flat_hash_map<uint32_t, std::vector<uint32_t>> components_;
};

// By distance, squared, then by the lesser vertex.
using Near = std::tuple<double, uint32_t, uint32_t>;

std::vector<double> ShortestEdges(const TriangleMesh& mesh,
                                  const Positions& points) {
  std::vector<double> shortest(mesh.NumVertices(),
                               std::numeric_limits<double>::infinity());
  for (const Triangle& face : mesh.faces)
    for (int i = 0; i < 3; ++i) {
      const uint32_t u = face[i], v = face[(i + 1) % 3];
      const double length = (points.row(u) - points.row(v)).squaredNorm();
      shortest[u] = std::min(shortest[u], length);
      shortest[v] = std::min(shortest[v], length);
    }
  return shortest;
}

std::vector<uint32_t> ComponentOfVertices(const TriangleMesh& mesh) {
  DisjointSets components(mesh.NumVertices());
  JoinCorners(mesh, components);
  return components.Representatives();
}

absl::StatusOr<std::vector<Near>> NearPairs(const TriangleMesh& mesh,
                                            const std::vector<uint32_t>& rim,
                                            const CancelToken& cancel) {
  constexpr double kOfEdge = 0.5;
  const Positions points = ToUnitBox(mesh).points;
  const std::vector<double> shortest = ShortestEdges(mesh, points);
  const VertexCloud cloud{points, rim};
  const VertexTree tree(3, cloud);
  std::vector<Near> pairs;
  MARROW_RETURN_IF_ERROR(ForEachIndex(rim.size(), cancel, [&](size_t i) {
    uint32_t nearest[kNearestShreds];
    double distances[kNearestShreds];
    const uint32_t u = rim[i];
    const Eigen::Vector3d place = points.row(u).transpose();
    const size_t found =
        tree.knnSearch(place.data(), kNearestShreds, nearest, distances);
    for (size_t k = 0; k < found; ++k) {
      const uint32_t v = rim[nearest[k]];
      if (u != v &&
          distances[k] < kOfEdge * kOfEdge * std::min(shortest[u], shortest[v]))
        pairs.push_back({distances[k], std::min(u, v), std::max(u, v)});
    }
  }));
  MARROW_RETURN_IF_ERROR(
      SortUnlessCancelled(pairs.begin(), pairs.end(), std::less<>(), cancel));
  return pairs;
}

}  // namespace

absl::StatusOr<std::vector<uint32_t>> SewShreds(const TriangleMesh& mesh,
                                                const CancelToken& cancel) {
  const Adjacency adjacency(mesh, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const std::vector<uint32_t> rim = RimVertices(adjacency);
  const std::vector<uint32_t> component = ComponentOfVertices(mesh);
  Seams seams(component);
  if (rim.empty()) return seams.Representatives();
  MARROW_ASSIGN_OR_RETURN(const std::vector<Near> pairs,
                          NearPairs(mesh, rim, cancel));
  MARROW_RETURN_IF_ERROR(ForEachIndex(pairs.size(), cancel, [&](size_t i) {
    seams.Sew(std::get<1>(pairs[i]), std::get<2>(pairs[i]));
  }));
  return seams.Representatives();
}

std::vector<uint32_t> SewRims(const TriangleMesh& mesh, double longest,
                              const CancelToken& cancel) {
  const Adjacency adjacency(mesh, cancel);
  if (cancel.IsCancelled()) return {};
  const std::vector<uint32_t> rim = RimVertices(adjacency);
  const std::vector<uint32_t> component = ComponentOfVertices(mesh);
  Seams seams(component);
  if (rim.empty()) return seams.Representatives();
  const absl::StatusOr<std::vector<uint32_t>> nearest =
      NearestAcross(mesh, rim, component, longest, cancel);
  if (!nearest.ok()) return {};
  const std::vector<uint32_t>& across = *nearest;
  for (bool mutual : {true, false})
    for (uint32_t i = 0; i < rim.size(); ++i)
      if (across[i] != i && (across[across[i]] == i) == mutual)
        seams.Sew(rim[i], rim[across[i]]);
  return seams.Representatives();
}

}  // namespace marrow
