#include "core/mesh/rims.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/mesh/angle.h"

namespace marrow {
namespace {

// The angles of a flat convex polygon of n corners sum to (n - 2) pi; those of
// any other, none taken as more than pi, to less.
constexpr double kFlat = 0.95;

struct RimEdge {
  uint32_t from;
  uint32_t to;
  uint32_t edge;
};

std::vector<uint32_t> EdgesOfRims(const Adjacency& adjacency) {
  std::vector<uint32_t> edges;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    if (adjacency.IsBoundaryEdge(e)) edges.push_back(e);
  return edges;
}

// From that end on at which fewer of the edges meet, by ends. So directed, no
// vertex has more than sqrt(2 n) of the n edges, and a hub of many rims does
// not cost the square of its degree.
std::vector<RimEdge> Directed(const Adjacency& adjacency,
                              const std::vector<uint32_t>& edges) {
  std::vector<uint32_t> degree(adjacency.NumVertices(), 0);
  for (uint32_t e : edges)
    for (uint32_t v : adjacency.EdgeVertices(e)) ++degree[v];
  std::vector<RimEdge> directed;
  directed.reserve(edges.size());
  for (uint32_t e : edges) {
    auto [a, b] = adjacency.EdgeVertices(e);
    if (degree[b] < degree[a]) std::swap(a, b);
    directed.push_back({a, b, e});
  }
  std::sort(directed.begin(), directed.end(),
            [](const RimEdge& x, const RimEdge& y) {
              return std::tie(x.from, x.to) < std::tie(y.from, y.to);
            });
  return directed;
}

struct Loop {
  uint32_t corners = 0;
  bool is_simple = true;
  double length = 0;
  double angles = 0;
};

class HoleFinder {
 public:
  HoleFinder(const Adjacency& adjacency, const Positions& positions)
      : adjacency_(adjacency), positions_(positions) {
    holes_.has_edge.assign(adjacency.NumEdges(), false);
  }

  Holes Find(double longest) && {
    FindTriangles();
    FindLoops(longest);
    return std::move(holes_);
  }

 private:
  void FindTriangles() {
    const std::vector<uint32_t> edges = EdgesOfRims(adjacency_);
    const std::vector<RimEdge> directed = Directed(adjacency_, edges);
    for (auto e = directed.begin(); e != directed.end(); ++e) {
      for (auto f = e + 1; f != directed.end() && f->from == e->from; ++f) {
        const auto between = EdgeOf(edges, e->to, f->to);
        if (between.has_value()) Close(*e, *f, *between);
      }
    }
  }

  // That of `edges` which joins two vertices.
  std::optional<uint32_t> EdgeOf(const std::vector<uint32_t>& edges, uint32_t a,
                                 uint32_t b) const {
    const std::array<uint32_t, 2> ends{std::min(a, b), std::max(a, b)};
    const auto found = std::partition_point(
        edges.begin(), edges.end(),
        [&](uint32_t e) { return adjacency_.EdgeVertices(e) < ends; });
    if (found == edges.end() || adjacency_.EdgeVertices(*found) != ends)
      return std::nullopt;
    return *found;
  }

  void Close(const RimEdge& e, const RimEdge& f, uint32_t between) {
    const bool is_face =
        adjacency_.EdgeFaces(e.edge)[0] == adjacency_.EdgeFaces(f.edge)[0];
    std::vector<bool>& taken = holes_.has_edge;
    if (is_face || taken[e.edge] || taken[f.edge] || taken[between]) return;
    taken[e.edge] = taken[f.edge] = taken[between] = true;
    for (const auto& [v, a, b] :
         {Triangle{e.from, e.to, f.to}, Triangle{e.to, e.from, f.to},
          Triangle{f.to, e.from, e.to}})
      holes_.corners.push_back({v, AngleAt(v, a, b)});
  }

  double AngleAt(uint32_t v, uint32_t a, uint32_t b) const {
    return Angle((positions_.row(a) - positions_.row(v)).transpose(),
                 (positions_.row(b) - positions_.row(v)).transpose());
  }

  // Of the edges that are left. Three are a face alone.
  void FindLoops(double longest) {
    std::vector<uint32_t> edges = EdgesOfRims(adjacency_);
    std::erase_if(edges, [&](uint32_t e) { return holes_.has_edge[e]; });
    const uint32_t n = adjacency_.NumVertices();
    DisjointSets connected(n);
    std::vector<std::vector<uint32_t>> neighbours(n);
    for (uint32_t e : edges) {
      const auto [a, b] = adjacency_.EdgeVertices(e);
      connected.Union(a, b);
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
    std::vector<Loop> loops(n);  // by representative
    std::vector<Holes::Corner> corners;
    for (uint32_t v = 0; v < n; ++v) {
      if (neighbours[v].empty()) continue;
      Loop& loop = loops[connected.Find(v)];
      ++loop.corners;
      for (uint32_t a : neighbours[v])
        loop.length += 0.5 * (positions_.row(v) - positions_.row(a)).norm();
      if (neighbours[v].size() != 2) loop.is_simple = false;
      corners.push_back(
          {v, AngleAt(v, neighbours[v][0], neighbours[v].back())});
      loop.angles += corners.back().angle;
    }
    const auto is_hole = [&](uint32_t v) {
      const Loop& loop = loops[connected.Find(v)];
      return loop.is_simple && loop.corners > 3 && loop.length <= longest &&
             loop.angles >= kFlat * (loop.corners - 2) * std::numbers::pi;
    };
    for (uint32_t e : edges)
      holes_.has_edge[e] = is_hole(adjacency_.EdgeVertices(e)[0]);
    for (const Holes::Corner& corner : corners)
      if (is_hole(corner.vertex)) holes_.corners.push_back(corner);
  }

  const Adjacency& adjacency_;
  const Positions& positions_;
  Holes holes_;
};

}  // namespace

std::vector<uint32_t> RimVertices(const Adjacency& adjacency) {
  std::vector<uint32_t> vertices;
  for (uint32_t e : EdgesOfRims(adjacency))
    for (uint32_t v : adjacency.EdgeVertices(e)) vertices.push_back(v);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::vector<uint32_t> RimOfVertices(const Adjacency& adjacency) {
  DisjointSets rims(adjacency.NumVertices());
  for (uint32_t e : EdgesOfRims(adjacency)) {
    const auto [a, b] = adjacency.EdgeVertices(e);
    rims.Union(a, b);
  }
  return rims.Representatives();
}

Holes SmallHoles(const Adjacency& adjacency, const Positions& positions,
                 double longest) {
  return HoleFinder(adjacency, positions).Find(longest);
}

}  // namespace marrow
