#include "core/boundaries/loops.h"

#include <algorithm>
#include <vector>

#include "core/base/disjoint_sets.h"

namespace marrow {
namespace {

// Edges that are connected where they have a vertex or a rim in common.
class Runs {
 public:
  Runs(const Adjacency& adjacency, const Positions& positions,
       const std::vector<uint32_t>& rim_of_vertex,
       std::span<const uint32_t> edges)
      : adjacency_(adjacency),
        positions_(positions),
        rim_of_vertex_(rim_of_vertex),
        vertices_(VerticesOf(edges)),
        connected_(static_cast<uint32_t>(vertices_.size())) {
    for (uint32_t e : edges) {
      const auto [u, v] = adjacency_.EdgeVertices(e);
      connected_.Union(Place(u), Place(v));
    }
  }

  uint32_t RunOf(uint32_t e) {
    return connected_.Find(Place(adjacency_.EdgeVertices(e)[0]));
  }

  // Of some of the edges, by run.
  std::vector<double> Lengths(std::span<const uint32_t> edges) {
    std::vector<double> lengths(vertices_.size(), 0);
    for (uint32_t e : edges) {
      const auto [u, v] = adjacency_.EdgeVertices(e);
      lengths[RunOf(e)] += (positions_.row(u) - positions_.row(v)).norm();
    }
    return lengths;
  }

 private:
  std::vector<uint32_t> VerticesOf(std::span<const uint32_t> edges) const {
    std::vector<uint32_t> vertices;
    for (uint32_t e : edges)
      for (uint32_t v : adjacency_.EdgeVertices(e))
        vertices.push_back(rim_of_vertex_[v]);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()),
                   vertices.end());
    return vertices;
  }

  uint32_t Place(uint32_t v) const {
    return static_cast<uint32_t>(std::lower_bound(vertices_.begin(),
                                                  vertices_.end(),
                                                  rim_of_vertex_[v]) -
                                 vertices_.begin());
  }

  const Adjacency& adjacency_;
  const Positions& positions_;
  const std::vector<uint32_t>& rim_of_vertex_;
  const std::vector<uint32_t> vertices_;
  DisjointSets connected_;
};

}  // namespace

double LargestLoopShare(const Adjacency& adjacency, const Positions& positions,
                        const std::vector<uint32_t>& rim_of_vertex,
                        std::span<const uint32_t> edges,
                        std::span<const uint32_t> beside, double longest_gap) {
  Runs gaps(adjacency, positions, rim_of_vertex, beside);
  const std::vector<double> breadths = gaps.Lengths(beside);
  double whole = 0;
  for (uint32_t e : edges) {
    const auto [u, v] = adjacency.EdgeVertices(e);
    whole += (positions.row(u) - positions.row(v)).norm();
  }
  std::vector<uint32_t> connected(edges.begin(), edges.end());
  for (uint32_t e : beside)
    if (breadths[gaps.RunOf(e)] <= longest_gap * whole) connected.push_back(e);
  const std::vector<double> lengths =
      Runs(adjacency, positions, rim_of_vertex, connected).Lengths(edges);
  return whole > 0 ? *std::max_element(lengths.begin(), lengths.end()) / whole
                   : 0;
}

}  // namespace marrow
