#include "client/samples/polygonize.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace marrow {
namespace {

using Lattice = std::array<int64_t, 3>;

// Cubes are visited in blocks, so that empty space costs one look a block.
constexpr int64_t kBlock = 8;
constexpr int64_t kSide = kBlock + 1;

// Six tetrahedra share the diagonal of a cube, each a walk from corner 0 to
// corner 7 that takes the axes in one of six orders. Corners are numbered by
// bits: x + 2y + 4z. All cubes are cut alike, so their faces match; the edges
// of the tetrahedra leave a corner in one of the directions 1 to 7.
struct Walk {
  std::array<int, 4> corners;
  bool is_right_handed;
};
constexpr std::array<Walk, 6> kWalks = {{{{0, 1, 3, 7}, true},
                                         {{0, 1, 5, 7}, false},
                                         {{0, 2, 3, 7}, false},
                                         {{0, 2, 6, 7}, true},
                                         {{0, 4, 5, 7}, true},
                                         {{0, 4, 6, 7}, false}}};

class TetrahedronMarcher {
 public:
  TetrahedronMarcher(const CreatureField& field, double cell)
      : field_(field), cell_(cell) {
    // The creatures are symmetric about x = 0: a lattice that is not keeps
    // its corners off the surface.
    origin_ = field.bounds().min() - cell * Eigen::Vector3d(1.37, 1.21, 1.29);
    const Eigen::Vector3d extent = field.bounds().max() - origin_;
    for (int i = 0; i < 3; ++i) {
      blocks_[i] = static_cast<int64_t>(extent[i] / (cell * kBlock)) + 1;
    }
  }

  SurfaceMesh Run() && {
    for (int64_t z = 0; z < blocks_[2]; ++z) {
      for (int64_t y = 0; y < blocks_[1]; ++y) {
        for (int64_t x = 0; x < blocks_[0]; ++x) {
          VisitBlock({x * kBlock, y * kBlock, z * kBlock});
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  static size_t InBlock(int64_t x, int64_t y, int64_t z) {
    return static_cast<size_t>((z * kSide + y) * kSide + x);
  }
  static int64_t Bit(int corner, int axis) { return (corner >> axis) & 1; }

  Eigen::Vector3d PointAt(const Lattice& at) const {
    return origin_ + cell_ * Eigen::Vector3d(static_cast<double>(at[0]),
                                             static_cast<double>(at[1]),
                                             static_cast<double>(at[2]));
  }

  void VisitBlock(const Lattice& first) {
    const Eigen::Vector3d half =
        Eigen::Vector3d::Constant(0.5 * cell_ * kBlock);
    if (std::abs(field_.At(PointAt(first) + half).value) > half.norm()) return;
    for (int64_t z = 0; z < kSide; ++z) {
      for (int64_t y = 0; y < kSide; ++y) {
        for (int64_t x = 0; x < kSide; ++x) {
          values_[InBlock(x, y, z)] =
              field_.At(PointAt({first[0] + x, first[1] + y, first[2] + z}))
                  .value;
        }
      }
    }
    for (int64_t z = 0; z < kBlock; ++z) {
      for (int64_t y = 0; y < kBlock; ++y) {
        for (int64_t x = 0; x < kBlock; ++x) VisitCube(first, {x, y, z});
      }
    }
  }

  void VisitCube(const Lattice& first, const Lattice& at) {
    int inside = 0;
    for (int c = 0; c < 8; ++c) {
      corner_values_[c] = values_[InBlock(at[0] + Bit(c, 0), at[1] + Bit(c, 1),
                                          at[2] + Bit(c, 2))];
      inside += corner_values_[c] < 0;
    }
    if (inside == 0 || inside == 8) return;
    cube_ = {first[0] + at[0], first[1] + at[1], first[2] + at[2]};
    for (const Walk& walk : kWalks) VisitTetrahedron(walk);
  }

  // Sorts the corners into inside and outside ones, keeping count of how the
  // order turned, so that every triangle comes out with its front outside.
  void VisitTetrahedron(const Walk& walk) {
    std::array<int, 4> order;
    size_t inside = 0;
    for (int c : walk.corners) {
      if (corner_values_[c] < 0) order[inside++] = c;
    }
    if (inside == 0 || inside == 4) return;
    size_t next = inside;
    for (int c : walk.corners) {
      if (corner_values_[c] >= 0) order[next++] = c;
    }
    bool right_handed = walk.is_right_handed;
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = i + 1; j < 4; ++j) {
        // The corners of a walk ascend.
        if (order[i] > order[j]) right_handed = !right_handed;
      }
    }
    Emit(order, inside, right_handed);
  }

  void Emit(const std::array<int, 4>& o, size_t inside, bool right_handed) {
    if (inside == 1) {
      AddFace(EdgeVertex(o[0], o[1]), EdgeVertex(o[0], o[2]),
              EdgeVertex(o[0], o[3]), right_handed);
    } else if (inside == 3) {
      AddFace(EdgeVertex(o[0], o[3]), EdgeVertex(o[1], o[3]),
              EdgeVertex(o[2], o[3]), right_handed);
    } else {
      const uint32_t v02 = EdgeVertex(o[0], o[2]);
      const uint32_t v03 = EdgeVertex(o[0], o[3]);
      const uint32_t v12 = EdgeVertex(o[1], o[2]);
      const uint32_t v13 = EdgeVertex(o[1], o[3]);
      AddFace(v02, v03, v13, right_handed);
      AddFace(v02, v13, v12, right_handed);
    }
  }

  void AddFace(uint32_t a, uint32_t b, uint32_t c, bool keep_order) {
    if (!keep_order) std::swap(b, c);
    mesh_.faces.push_back({a, b, c});
  }

  uint32_t EdgeVertex(int c, int d) {
    const int low = std::min(c, d);
    const int high = std::max(c, d);
    const Lattice at = {cube_[0] + Bit(low, 0), cube_[1] + Bit(low, 1),
                        cube_[2] + Bit(low, 2)};
    const int64_t corner = (at[2] * (blocks_[1] * kBlock + 1) + at[1]) *
                               (blocks_[0] * kBlock + 1) +
                           at[0];
    const auto next_id = static_cast<uint32_t>(mesh_.positions.size());
    const auto [it, is_new] =
        vertex_of_edge_.try_emplace(corner * 8 + (high - low), next_id);
    if (is_new) {
      // Kept off the corners: no two vertices of a cube coincide.
      const double share = std::clamp(
          corner_values_[low] / (corner_values_[low] - corner_values_[high]),
          0.02, 0.98);
      Eigen::Vector3d step;
      for (int i = 0; i < 3; ++i) {
        step[i] = static_cast<double>(Bit(high, i) - Bit(low, i));
      }
      mesh_.positions.push_back(PointAt(at) + share * cell_ * step);
    }
    return it->second;
  }

  const CreatureField& field_;
  const double cell_;
  Eigen::Vector3d origin_;
  Lattice blocks_;
  Lattice cube_;
  std::array<double, kSide * kSide * kSide> values_;
  std::array<double, 8> corner_values_;
  std::unordered_map<int64_t, uint32_t> vertex_of_edge_;
  SurfaceMesh mesh_;
};

}  // namespace

SurfaceMesh Polygonize(const CreatureField& field, double cell) {
  return TetrahedronMarcher(field, cell).Run();
}

}  // namespace marrow
