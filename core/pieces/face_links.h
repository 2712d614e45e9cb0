// Bridges between shells, and places where shells touch in a vertex, as the
// fronts see them: pairs of faces.
#ifndef MARROW_CORE_PIECES_FACE_LINKS_H_
#define MARROW_CORE_PIECES_FACE_LINKS_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/adjacency.h"

namespace marrow {

// Pairs of faces that share a vertex, of shells that share no edge: at each
// such vertex the least face of every shell with the least face of all.
std::vector<std::array<uint32_t, 2>> TouchingFaces(const Adjacency& adjacency);

// For each bridge between two vertices, a link between the least faces of the
// two: one face stands for all around its vertex, or a hub with many bridges
// would cost the square of its degree. Faces that touch are linked as well.
// Immutable, thread safe.
class FaceLinks {
 public:
  FaceLinks() = default;
  FaceLinks(const Adjacency& adjacency,
            std::span<const std::array<uint32_t, 2>> bridges);

  // The faces linked to f, ascending, each once.
  std::span<const uint32_t> Of(uint32_t f) const {
    if (offsets_.empty()) return {};
    return {faces_.data() + offsets_[f], offsets_[f + 1] - offsets_[f]};
  }
  bool empty() const { return faces_.empty(); }

 private:
  std::vector<uint32_t> offsets_;  // empty where there are no links
  std::vector<uint32_t> faces_;
};

}  // namespace marrow

#endif  // MARROW_CORE_PIECES_FACE_LINKS_H_
