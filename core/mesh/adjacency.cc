#include "core/mesh/adjacency.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/cancellable.h"

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
absl::Status SortByKey(uint32_t num_keys, const Key& key,
                       const CancelToken& cancel,
                       std::vector<uint32_t>& items) {
  std::vector<uint32_t> next(size_t{num_keys} + 1, 0);
  MARROW_RETURN_IF_ERROR(ForEachIndex(
      items.size(), cancel, [&](size_t i) { ++next[key(items[i]) + 1]; }));
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<uint32_t> sorted(items.size());
  MARROW_RETURN_IF_ERROR(ForEachIndex(items.size(), cancel, [&](size_t i) {
    sorted[next[key(items[i])]++] = items[i];
  }));
  items = std::move(sorted);
  return absl::OkStatus();
}

}  // namespace

Adjacency::Adjacency(const TriangleMesh& mesh, const CancelToken& cancel) {
  // What is cancelled is known to those who hold the token.
  if (BuildVertexFaces(mesh, cancel).ok()) (void)BuildEdges(mesh, cancel);
}

absl::Status Adjacency::BuildVertexFaces(const TriangleMesh& mesh,
                                         const CancelToken& cancel) {
  vertex_offsets_.assign(size_t{mesh.NumVertices()} + 1, 0);
  MARROW_RETURN_IF_ERROR(ForEachIndex(mesh.faces.size(), cancel, [&](size_t f) {
    for (uint32_t v : mesh.faces[f]) ++vertex_offsets_[v + 1];
  }));
  std::partial_sum(vertex_offsets_.begin(), vertex_offsets_.end(),
                   vertex_offsets_.begin());
  vertex_faces_.resize(3 * mesh.faces.size());
  std::vector<uint32_t> next(vertex_offsets_.begin(),
                             vertex_offsets_.end() - 1);
  return ForEachIndex(mesh.faces.size(), cancel, [&](size_t f) {
    for (uint32_t v : mesh.faces[f])
      vertex_faces_[next[v]++] = static_cast<uint32_t>(f);
  });
}

absl::Status Adjacency::BuildEdges(const TriangleMesh& mesh,
                                   const CancelToken& cancel) {
  std::vector<uint32_t> sides(3 * mesh.faces.size());
  std::iota(sides.begin(), sides.end(), 0);
  // Least significant key first; stability keeps faces ascending in an edge.
  for (int end : {1, 0}) {
    const auto key = [&](uint32_t side) {
      return SideVertices(mesh, side)[end];
    };
    MARROW_RETURN_IF_ERROR(SortByKey(mesh.NumVertices(), key, cancel, sides));
  }
  face_edges_.resize(mesh.faces.size());
  edge_faces_.reserve(sides.size());
  edge_vertices_.reserve(sides.size() / 2 + 1);
  edge_offsets_.reserve(sides.size() / 2 + 2);
  MARROW_RETURN_IF_ERROR(ForEachIndex(sides.size(), cancel, [&](size_t i) {
    const uint32_t side = sides[i];
    const std::array<uint32_t, 2> vertices = SideVertices(mesh, side);
    // Not by !=, which calls memcmp for these eight bytes.
    if (edge_vertices_.empty() || edge_vertices_.back()[0] != vertices[0] ||
        edge_vertices_.back()[1] != vertices[1]) {
      edge_vertices_.push_back(vertices);
      edge_offsets_.push_back(static_cast<uint32_t>(edge_faces_.size()));
    }
    face_edges_[side / 3][side % 3] = NumEdges() - 1;
    edge_faces_.push_back(side / 3);
  }));
  edge_offsets_.push_back(static_cast<uint32_t>(edge_faces_.size()));
  return absl::OkStatus();
}

}  // namespace marrow
