#include "core/boundaries/loops.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "core/base/disjoint_sets.h"

namespace marrow {
namespace {

struct Loop {
  uint32_t num_edges = 0;
  uint32_t num_vertices = 0;
  double length = 0;
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d area = Eigen::Vector3d::Zero();

  double Roundness() const {
    // Every vertex of a closed loop has two edges, or more where loops touch.
    if (num_edges < num_vertices || length <= 0) return 0;
    return std::min(1.0,
                    4 * std::numbers::pi * area.norm() / (length * length));
  }
};

std::vector<uint32_t> VerticesOf(const Adjacency& adjacency,
                                 std::span<const uint32_t> edges) {
  std::vector<uint32_t> vertices;
  for (uint32_t e : edges)
    for (uint32_t v : adjacency.EdgeVertices(e)) vertices.push_back(v);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// The ends of an edge in the order in which the face inside has them.
std::array<uint32_t, 2> Directed(const TriangleMesh& mesh,
                                 const Adjacency& adjacency, uint32_t e,
                                 const std::function<bool(uint32_t)>& inside) {
  const auto [u, v] = adjacency.EdgeVertices(e);
  for (uint32_t f : adjacency.EdgeFaces(e)) {
    if (!inside(f)) continue;
    for (int i = 0; i < 3; ++i)
      if (mesh.faces[f][i] == v && mesh.faces[f][(i + 1) % 3] == u)
        return {v, u};
    break;
  }
  return {u, v};
}

}  // namespace

LoopShape ShapeOfLoops(const TriangleMesh& mesh, const Adjacency& adjacency,
                       const Positions& positions,
                       std::span<const uint32_t> edges,
                       const std::function<bool(uint32_t)>& inside) {
  const std::vector<uint32_t> vertices = VerticesOf(adjacency, edges);
  auto place = [&](uint32_t v) {
    return static_cast<uint32_t>(
        std::lower_bound(vertices.begin(), vertices.end(), v) -
        vertices.begin());
  };
  auto at = [&](uint32_t v) { return positions.row(v).transpose(); };
  DisjointSets connected(static_cast<uint32_t>(vertices.size()));
  for (uint32_t e : edges) {
    const auto [u, v] = adjacency.EdgeVertices(e);
    connected.Union(place(u), place(v));
  }
  std::vector<Loop> loops(vertices.size());
  for (uint32_t i = 0; i < vertices.size(); ++i)
    if (Loop& loop = loops[connected.Find(i)]; loop.num_vertices++ == 0)
      loop.start = at(vertices[i]);
  double whole = 0;
  for (uint32_t e : edges) {
    const auto [u, v] = Directed(mesh, adjacency, e, inside);
    Loop& loop = loops[connected.Find(place(u))];
    const Eigen::Vector3d a = at(u) - loop.start, b = at(v) - loop.start;
    loop.area += 0.5 * a.cross(b);
    loop.length += (b - a).norm();
    ++loop.num_edges;
    whole += (b - a).norm();
  }
  LoopShape shape;
  if (whole <= 0) return shape;
  for (const Loop& loop : loops) {
    shape.roundness += loop.length / whole * loop.Roundness();
    shape.largest = std::max(shape.largest, loop.length / whole);
  }
  return shape;
}

}  // namespace marrow
