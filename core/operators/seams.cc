#include "core/operators/seams.h"

#include <algorithm>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "core/base/cancellable.h"
#include "core/base/disjoint_sets.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/components.h"
#include "core/mesh/rims.h"
#include "core/mesh/unit_box.h"
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
    if (std::adjacent_find(joined.begin(), joined.end()) != joined.end())
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

}  // namespace

std::vector<uint32_t> SewRims(const TriangleMesh& mesh, double longest,
                              const CancelToken& cancel) {
  const Adjacency adjacency(mesh, cancel);
  if (cancel.IsCancelled()) return {};
  const std::vector<uint32_t> rim = RimVertices(adjacency);
  DisjointSets components(mesh.NumVertices());
  JoinCorners(mesh, components);
  const std::vector<uint32_t> component = components.Representatives();
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
