// Union-find with a parity: whether a face is turned against its
// representative.
#include "core/mesh/orientation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/cancellable.h"
#include "core/mesh/unit_box.h"

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

 private:
  std::vector<uint32_t> parent_;
  std::vector<bool> turned_;
  std::vector<uint32_t> size_;
  std::vector<bool> one_sided_;
};

ParitySets JoinFaces(const TriangleMesh& mesh, const Adjacency& adjacency,
                     const CancelToken& cancel) {
  ParitySets sets(mesh.NumFaces());
  const auto join = [&](uint32_t e) {
    const auto faces = adjacency.EdgeFaces(e);
    if (faces.size() != 2) return;
    const auto [v, w] = adjacency.EdgeVertices(e);
    sets.Join(faces[0], faces[1],
              RunsAlong(mesh.faces[faces[0]], v, w) ==
                  RunsAlong(mesh.faces[faces[1]], v, w));
  };
  (void)ForEachIndex(adjacency.NumEdges(), cancel, join);
  return sets;
}

// `is_turned` is against the least face of the part; makes it that of the
// fewer.
void TurnTheFewer(Sides& sides) {
  std::vector<int64_t> surplus(sides.NumParts(), 0);  // turned less not turned
  for (size_t f = 0; f < sides.part.size(); ++f)
    surplus[sides.part[f]] += sides.is_turned[f] ? 1 : -1;
  for (size_t f = 0; f < sides.part.size(); ++f)
    if (surplus[sides.part[f]] > 0) sides.is_turned[f] = !sides.is_turned[f];
}

// The mean corner of each part.
std::vector<Eigen::Vector3d> Centers(const TriangleMesh& mesh,
                                     const Positions& unit, const Sides& sides,
                                     const CancelToken& cancel) {
  std::vector<Eigen::Vector3d> centers(sides.NumParts(),
                                       Eigen::Vector3d::Zero());
  std::vector<double> corners(sides.NumParts(), 0);
  (void)ForEachIndex(mesh.faces.size(), cancel, [&](size_t f) {
    for (uint32_t v : mesh.faces[f])
      centers[sides.part[f]] += unit.row(v).transpose();
    corners[sides.part[f]] += 3;
  });
  for (uint32_t i = 0; i < sides.NumParts(); ++i) centers[i] /= corners[i];
  return centers;
}

}  // namespace

bool RunsAlong(const Triangle& face, uint32_t v, uint32_t w) {
  for (int i = 0; i < 3; ++i)
    if (face[i] == v) return face[(i + 1) % 3] == w;
  return false;
}

Sides FindSides(const TriangleMesh& mesh, const Adjacency& adjacency,
                const CancelToken& cancel) {
  const uint32_t n = mesh.NumFaces();
  const ParitySets sets = JoinFaces(mesh, adjacency, cancel);
  if (cancel.IsCancelled()) return {};
  Sides sides{std::vector<uint32_t>(n), std::vector<bool>(n), {}};
  std::vector<uint32_t> part(n, kNoIndex);  // by representative, as the next
  std::vector<bool> least_is_turned(n);
  const auto number = [&](uint32_t f) {
    const auto [set, is_turned] = sets.Find(f);
    if (part[set] == kNoIndex) {
      part[set] = sides.NumParts();
      least_is_turned[set] = is_turned;
      sides.is_one_sided.push_back(sets.IsOneSided(set));
    }
    sides.part[f] = part[set];
    sides.is_turned[f] = is_turned != least_is_turned[set];
  };
  (void)ForEachIndex(n, cancel, number);
  if (!cancel.IsCancelled()) TurnTheFewer(sides);
  return sides;
}

Orientation CheckOrientation(const TriangleMesh& mesh,
                             const Adjacency& adjacency,
                             const CancelToken& cancel) {
  const Sides sides = FindSides(mesh, adjacency, cancel);
  if (cancel.IsCancelled()) return {};
  Orientation result;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    if (sides.is_one_sided[sides.part[f]]) {
      result.orientable = false;
    } else {
      result.flipped_faces += sides.is_turned[f];
    }
  }
  return result;
}

std::vector<bool> FacesInward(const TriangleMesh& mesh, const Sides& sides,
                              const CancelToken& cancel) {
  const Positions unit = mesh.positions * UnitScale(mesh);
  const std::vector<Eigen::Vector3d> centers =
      Centers(mesh, unit, sides, cancel);
  // By part, once those that are turned are turned over.
  std::vector<double> volumes(sides.NumParts(), 0);
  const auto add_volume = [&](size_t f) {
    const Eigen::Vector3d& center = centers[sides.part[f]];
    const auto from_center = [&](int corner) -> Eigen::Vector3d {
      return unit.row(mesh.faces[f][corner]).transpose() - center;
    };
    const double volume =
        from_center(0).dot(from_center(1).cross(from_center(2)));
    volumes[sides.part[f]] += sides.is_turned[f] ? -volume : volume;
  };
  (void)ForEachIndex(mesh.faces.size(), cancel, add_volume);
  std::vector<bool> inward(mesh.NumFaces());
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    inward[f] = sides.is_turned[f] != (volumes[sides.part[f]] < 0);
  return inward;
}

}  // namespace marrow
