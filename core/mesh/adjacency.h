// Which faces meet at a vertex, and which across an edge.
#ifndef MARROW_CORE_MESH_ADJACENCY_H_
#define MARROW_CORE_MESH_ADJACENCY_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Undirected edges and incidences of a mesh. An edge may have any number of
// faces: one at a boundary, two inside a manifold, more where sheets meet. The
// neighbours of face f across its edge e are EdgeFaces(e) without f; they are
// never stored as pairs, so an edge of k faces costs O(k).
//
// Keeps no reference to the mesh. Immutable, hence thread safe; the spans live
// as long as the object. Time and memory are linear in the size of the mesh.
class Adjacency {
 public:
  // Of no use once cancelled. REQUIRES: every face has three different
  // corners, all < NumVertices().
  explicit Adjacency(const TriangleMesh& mesh,
                     const CancelToken& cancel = CancelToken());

  uint32_t NumVertices() const {
    return static_cast<uint32_t>(vertex_offsets_.size() - 1);
  }
  uint32_t NumFaces() const {
    return static_cast<uint32_t>(face_edges_.size());
  }
  // Edges are numbered in ascending order of EdgeVertices().
  uint32_t NumEdges() const {
    return static_cast<uint32_t>(edge_vertices_.size());
  }

  // The lesser vertex first.
  std::array<uint32_t, 2> EdgeVertices(uint32_t e) const {
    return edge_vertices_[e];
  }
  // Ascending, at least one, no face twice.
  std::span<const uint32_t> EdgeFaces(uint32_t e) const {
    return {edge_faces_.data() + edge_offsets_[e],
            edge_offsets_[e + 1] - edge_offsets_[e]};
  }
  bool IsBoundaryEdge(uint32_t e) const { return EdgeFaces(e).size() == 1; }

  // Entry i is the edge between corners i and (i + 1) % 3.
  const std::array<uint32_t, 3>& FaceEdges(uint32_t f) const {
    return face_edges_[f];
  }

  // Ascending; empty for a vertex that no face uses.
  std::span<const uint32_t> VertexFaces(uint32_t v) const {
    return {vertex_faces_.data() + vertex_offsets_[v],
            vertex_offsets_[v + 1] - vertex_offsets_[v]};
  }

 private:
  absl::Status BuildVertexFaces(const TriangleMesh& mesh,
                                const CancelToken& cancel);
  absl::Status BuildEdges(const TriangleMesh& mesh, const CancelToken& cancel);

  std::vector<uint32_t> vertex_offsets_;
  std::vector<uint32_t> vertex_faces_;
  std::vector<std::array<uint32_t, 2>> edge_vertices_;
  std::vector<uint32_t> edge_offsets_;
  std::vector<uint32_t> edge_faces_;
  std::vector<std::array<uint32_t, 3>> face_edges_;
};

}  // namespace marrow

#endif  // MARROW_CORE_MESH_ADJACENCY_H_
