#include "core/hierarchy/merged_pieces.h"

#include <algorithm>

namespace marrow {

MergedPieces JoinPieces(const Bodies& bodies,
                        const std::vector<MergeTree>& trees) {
  MergedPieces joined;
  joined.piece_of_face.resize(bodies.anchors.size());
  MergeOrder& order = joined.order;
  for (size_t b = 0; b < trees.size(); ++b) {
    const uint32_t first = order.num_pieces;
    const std::vector<uint32_t>& faces = bodies.bodies[b].faces;
    for (size_t f = 0; f < faces.size(); ++f)
      joined.piece_of_face[faces[f]] = first + trees[b].piece_of_face[f];
    for (const PieceMerge& merge : trees[b].order.merges)
      order.merges.push_back(
          {first + merge.a, first + merge.b, merge.salience});
    order.num_pieces += trees[b].order.num_pieces;
  }
  std::stable_sort(order.merges.begin(), order.merges.end(),
                   [](const PieceMerge& x, const PieceMerge& y) {
                     return x.salience < y.salience;
                   });
  for (size_t f = 0; f < bodies.anchors.size(); ++f)
    joined.piece_of_face[f] = joined.piece_of_face[bodies.anchors[f]];
  return joined;
}

}  // namespace marrow
