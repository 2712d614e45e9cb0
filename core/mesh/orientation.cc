// Union-find with a parity: whether a face is turned against its
// representative.
#include "core/mesh/orientation.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace marrow {
namespace {

class ParitySets {
 public:
  explicit ParitySets(uint32_t n)
      : parent_(n), turned_(n, false), size_(n, 1), one_sided_(n, false) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  // The representative of x, and whether x is turned against it. Unions by
  // size keep the way short.
  std::pair<uint32_t, bool> Find(uint32_t x) const {
    bool turned = false;
    while (parent_[x] != x) {
      turned ^= turned_[x];
      x = parent_[x];
    }
    return {x, turned};
  }

  void Join(uint32_t x, uint32_t y, bool turned) {
    auto [a, x_turned] = Find(x);
    auto [b, y_turned] = Find(y);
    const bool between = turned ^ x_turned ^ y_turned;
    if (a == b) {
      if (between) one_sided_[a] = true;
      return;
    }
    if (size_[a] < size_[b]) std::swap(a, b);
    parent_[b] = a;
    turned_[b] = between;
    size_[a] += size_[b];
    if (one_sided_[b]) one_sided_[a] = true;
  }

  bool IsOneSided(uint32_t representative) const {
    return one_sided_[representative];
  }
  uint32_t Size(uint32_t representative) const { return size_[representative]; }

 private:
  std::vector<uint32_t> parent_;
  std::vector<bool> turned_;
  std::vector<uint32_t> size_;
  std::vector<bool> one_sided_;
};

// Whether the face runs from v to w along their edge.
bool RunsAlong(const Triangle& face, uint32_t v, uint32_t w) {
  for (int i = 0; i < 3; ++i)
    if (face[i] == v) return face[(i + 1) % 3] == w;
  return false;
}

}  // namespace

Orientation CheckOrientation(const TriangleMesh& mesh,
                             const Adjacency& adjacency) {
  ParitySets sets(mesh.NumFaces());
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const auto faces = adjacency.EdgeFaces(e);
    if (faces.size() != 2) continue;
    const auto [v, w] = adjacency.EdgeVertices(e);
    sets.Join(faces[0], faces[1],
              RunsAlong(mesh.faces[faces[0]], v, w) ==
                  RunsAlong(mesh.faces[faces[1]], v, w));
  }
  std::vector<uint32_t> turned(mesh.NumFaces(), 0);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const auto [representative, is_turned] = sets.Find(f);
    turned[representative] += is_turned;
  }
  Orientation result;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    if (sets.Find(f).first != f) continue;
    if (sets.IsOneSided(f)) {
      result.orientable = false;
    } else {
      result.flipped_faces += std::min(turned[f], sets.Size(f) - turned[f]);
    }
  }
  return result;
}

}  // namespace marrow
