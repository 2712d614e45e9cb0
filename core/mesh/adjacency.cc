#include "core/mesh/adjacency.h"

#include <algorithm>
#include <numeric>

namespace marrow {
namespace {

// A side is one face's share of an edge: number 3 * f + i runs from corner i
// of face f to the next.
std::array<uint32_t, 2> SideVertices(const TriangleMesh& mesh, uint32_t side) {
  const Triangle& face = mesh.faces[side / 3];
  const uint32_t a = face[side % 3];
  const uint32_t b = face[(side % 3 + 1) % 3];
  return {std::min(a, b), std::max(a, b)};
}

// Stable counting sort of `items` by key(item) < num_keys.
template <typename Key>
std::vector<uint32_t> SortByKey(const std::vector<uint32_t>& items,
                                uint32_t num_keys, const Key& key) {
  std::vector<uint32_t> next(size_t{num_keys} + 1, 0);
  for (uint32_t item : items) ++next[key(item) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<uint32_t> sorted(items.size());
  for (uint32_t item : items) sorted[next[key(item)]++] = item;
  return sorted;
}

}  // namespace

Adjacency::Adjacency(const TriangleMesh& mesh) {
  BuildVertexFaces(mesh);
  BuildEdges(mesh);
}

void Adjacency::BuildVertexFaces(const TriangleMesh& mesh) {
  vertex_offsets_.assign(size_t{mesh.NumVertices()} + 1, 0);
  for (const Triangle& face : mesh.faces) {
    for (uint32_t v : face) ++vertex_offsets_[v + 1];
  }
  std::partial_sum(vertex_offsets_.begin(), vertex_offsets_.end(),
                   vertex_offsets_.begin());
  vertex_faces_.resize(3 * mesh.faces.size());
  std::vector<uint32_t> next(vertex_offsets_.begin(),
                             vertex_offsets_.end() - 1);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    for (uint32_t v : mesh.faces[f]) vertex_faces_[next[v]++] = f;
  }
}

void Adjacency::BuildEdges(const TriangleMesh& mesh) {
  std::vector<uint32_t> sides(3 * mesh.faces.size());
  std::iota(sides.begin(), sides.end(), 0);
  // Least significant key first; stability keeps faces ascending in an edge.
  for (int end : {1, 0}) {
    sides = SortByKey(sides, mesh.NumVertices(), [&](uint32_t side) {
      return SideVertices(mesh, side)[end];
    });
  }
  face_edges_.resize(mesh.faces.size());
  edge_faces_.reserve(sides.size());
  edge_vertices_.reserve(sides.size() / 2 + 1);
  edge_offsets_.reserve(sides.size() / 2 + 2);
  for (uint32_t side : sides) {
    const std::array<uint32_t, 2> vertices = SideVertices(mesh, side);
    // Not by !=, which calls memcmp for these eight bytes.
    if (edge_vertices_.empty() || edge_vertices_.back()[0] != vertices[0] ||
        edge_vertices_.back()[1] != vertices[1]) {
      edge_vertices_.push_back(vertices);
      edge_offsets_.push_back(static_cast<uint32_t>(edge_faces_.size()));
    }
    face_edges_[side / 3][side % 3] = NumEdges() - 1;
    edge_faces_.push_back(side / 3);
  }
  edge_offsets_.push_back(static_cast<uint32_t>(edge_faces_.size()));
}

}  // namespace marrow
