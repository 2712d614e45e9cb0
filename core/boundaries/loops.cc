#include "core/boundaries/loops.h"

#include <algorithm>
#include <vector>

#include "core/base/disjoint_sets.h"

namespace marrow {

double LargestLoopShare(const Adjacency& adjacency, const Positions& positions,
                        const std::vector<uint32_t>& rim_of_vertex,
                        std::span<const uint32_t> edges) {
  std::vector<uint32_t> vertices;
  for (uint32_t e : edges)
    for (uint32_t v : adjacency.EdgeVertices(e))
      vertices.push_back(rim_of_vertex[v]);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  auto place = [&](uint32_t v) {
    return static_cast<uint32_t>(
        std::lower_bound(vertices.begin(), vertices.end(), rim_of_vertex[v]) -
        vertices.begin());
  };
  DisjointSets connected(static_cast<uint32_t>(vertices.size()));
  for (uint32_t e : edges) {
    const auto [u, v] = adjacency.EdgeVertices(e);
    connected.Union(place(u), place(v));
  }
  std::vector<double> lengths(vertices.size(), 0);
  double whole = 0, largest = 0;
  for (uint32_t e : edges) {
    const auto [u, v] = adjacency.EdgeVertices(e);
    const double length = (positions.row(u) - positions.row(v)).norm();
    whole += length;
    double& part = lengths[connected.Find(place(u))];
    largest = std::max(largest, part += length);
  }
  return whole > 0 ? largest / whole : 0;
}

}  // namespace marrow
