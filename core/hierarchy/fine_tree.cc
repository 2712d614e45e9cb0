#include "core/hierarchy/fine_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/base/status_macros.h"
#include "core/boundaries/boundary_mover.h"
#include "core/operators/laplacian.h"

namespace marrow {
namespace {

// The edge of a triangle of the mean area, equilateral, of a mesh of area 1.
double UsualEdge(const TriangleMesh& mesh) {
  return std::sqrt(4 / std::sqrt(3.0) / mesh.NumFaces());
}

// `piece_of_coarse` and `piece_of_fine` name the piece of each face; no node
// divides a piece.
SegmentTree Spread(const SegmentTree& tree, const CoarseMesh& coarse,
                   const TriangleMesh& fine,
                   const std::vector<uint32_t>& piece_of_coarse,
                   const std::vector<uint32_t>& piece_of_fine) {
  SegmentTree result = tree;
  for (SegmentNode& node : result.nodes) node.faces.clear();
  result.nodes[0].faces.resize(piece_of_fine.size());
  std::iota(result.nodes[0].faces.begin(), result.nodes[0].faces.end(), 0u);
  std::vector<uint32_t> node_of_piece(coarse.faces.size());
  for (const SegmentNode& node : tree.nodes) {
    for (uint32_t child : node.children)
      for (uint32_t f : tree.nodes[child].faces)
        node_of_piece[piece_of_coarse[f]] = child;
    if (node.children.empty()) continue;
    for (uint32_t f : result.nodes[node.id].faces)
      result.nodes[node_of_piece[piece_of_fine[f]]].faces.push_back(f);
  }
  for (SegmentNode& node : result.nodes)
    node.medial_structure =
        ToFine(node.medial_structure, coarse, fine, node.faces);
  return result;
}

// Those of `vertices` that the faces have; a corner of the first where there
// are none.
std::vector<uint32_t> OfFaces(const std::vector<uint32_t>& vertices,
                              const TriangleMesh& mesh,
                              const std::vector<uint32_t>& faces) {
  std::vector<bool> has(mesh.NumVertices(), false);
  for (uint32_t f : faces)
    for (uint32_t v : mesh.faces[f]) has[v] = true;
  std::vector<uint32_t> result;
  for (uint32_t v : vertices)
    if (has[v]) result.push_back(v);
  if (result.empty()) result.push_back(mesh.faces[faces.front()][0]);
  return result;
}

// Whether every piece has one of the first `count` faces.
bool AllHaveFaces(const std::vector<uint32_t>& piece_of_face, uint32_t count,
                  uint32_t pieces) {
  std::vector<bool> has(pieces, false);
  for (uint32_t f = 0; f < count; ++f) has[piece_of_face[f]] = true;
  return std::ranges::find(has, false) == has.end();
}

}  // namespace

std::vector<uint32_t> ToFine(const std::vector<uint32_t>& vertices,
                             const CoarseMesh& coarse, const TriangleMesh& fine,
                             const std::vector<uint32_t>& faces) {
  std::vector<uint32_t> own;
  own.reserve(vertices.size());
  for (uint32_t v : vertices) own.push_back(coarse.vertices[v]);
  return OfFaces(own, fine, faces);
}

SegmentTree ToFine(const SegmentTree& tree, const CoarseMesh& coarse,
                   const TriangleMesh& fine) {
  std::vector<uint32_t> own(coarse.faces.size());
  std::iota(own.begin(), own.end(), 0u);
  return Spread(tree, coarse, fine, own, coarse.coarse_face);
}

SegmentTree WithoutPatches(const SegmentTree& tree, const TriangleMesh& mesh,
                           uint32_t count) {
  SegmentTree result = tree;
  for (SegmentNode& node : result.nodes) {
    node.faces.erase(
        std::lower_bound(node.faces.begin(), node.faces.end(), count),
        node.faces.end());
    node.medial_structure = OfFaces(node.medial_structure, mesh, node.faces);
  }
  return result;
}

absl::StatusOr<MergeTree> ToFine(const MergeTree& merged,
                                 const CoarseMesh& coarse,
                                 const TriangleMesh& fine, uint32_t count,
                                 const Adjacency& adjacency,
                                 const FaceLinks& links,
                                 const CancelToken& cancel) {
  constexpr double kBreadth = 2;  // in coarse edges
  MergeTree result;
  result.order = merged.order;
  result.piece_of_face = coarse.coarse_face;
  for (uint32_t& piece : result.piece_of_face)
    piece = merged.piece_of_face[piece];
  const std::vector<uint32_t> as_coarse = result.piece_of_face;
  MARROW_RETURN_IF_ERROR(
      SmoothBoundaries(fine, adjacency, FaceAreaShares(fine), links,
                       kBreadth * UsualEdge(coarse.canonical.mesh), cancel,
                       result.piece_of_face));
  if (!AllHaveFaces(result.piece_of_face, count, merged.order.num_pieces))
    result.piece_of_face = as_coarse;
  result.tree = Spread(merged.tree, coarse, fine, merged.piece_of_face,
                       result.piece_of_face);
  return result;
}

}  // namespace marrow
