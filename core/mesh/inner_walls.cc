#include "core/mesh/inner_walls.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include "core/base/cancellable.h"
#include "core/base/disjoint_sets.h"
#include "core/base/status_macros.h"
#include "core/mesh/orientation.h"
#include "core/mesh/unit_box.h"

namespace marrow {
namespace {

// How far from its plane, of its extent: more than rounding to 24 bits makes of
// a part of a body.
constexpr double kFlat = 1e-4;

// Of the cosine between two faces of an edge: they lie on each other.
constexpr double kFolded = 1 - 1e-6;

// Of the cosine between a face's normal and a wall: neither behind the face nor
// before it.
constexpr double kLevel = 1e-3;

// Where a panel ends: at an edge of one side, of more than two, or of two that
// lie on each other.
struct Border {
  uint32_t panel;
  uint32_t edge;
  bool forward;
  bool is_open;
};

// Of one panel, by edge.
using Borders = std::span<const Border>;

class WallFinder {
 public:
  WallFinder(const TriangleMesh& mesh, const Adjacency& adjacency,
             const std::vector<Directions>& directions,
             const CancelToken& cancel)
      : mesh_(mesh),
        adjacency_(adjacency),
        directions_(directions),
        cancel_(cancel),
        panels_(0) {}

  absl::StatusOr<std::vector<uint32_t>> Find() {
    if (!HasCrowdedEdge()) return std::vector<uint32_t>();
    panels_ = DisjointSets(2 * mesh_.NumFaces());
    unit_ = mesh_.positions * UnitScale(mesh_);
    MARROW_RETURN_IF_ERROR(FindBorders());
    MARROW_RETURN_IF_ERROR(PairPanels());
    if (num_walls_ == 0) return std::vector<uint32_t>();
    MARROW_RETURN_IF_ERROR(KeepWallsUnlessInside());
    MARROW_RETURN_IF_ERROR(FindOutside(/*agreeing=*/true));
    MARROW_RETURN_IF_ERROR(FindOutside(/*agreeing=*/false));
    return std::move(outside_);
  }

 private:
  bool Exists(uint32_t side) const {
    return side % 2 < directions_[side / 2].NumSides();
  }

  bool Descends(uint32_t side) const {
    const Directions& d = directions_[side / 2];
    return d.AreBoth() ? side % 2 == 1 : d.ascending == 0;
  }

  // visit(side, whether it runs along the edge from its lesser end)
  template <typename Visit>
  void ForEachSideAt(uint32_t e, const Visit& visit) const {
    const auto [v, w] = adjacency_.EdgeVertices(e);
    for (uint32_t f : adjacency_.EdgeFaces(e))
      for (uint32_t side : {2 * f, 2 * f + 1})
        if (Exists(side))
          visit(side, RunsAlong(mesh_.faces[f], v, w) != Descends(side));
  }

  uint32_t CountAt(uint32_t e) const {
    uint32_t count = 0;
    for (uint32_t f : adjacency_.EdgeFaces(e))
      count += directions_[f].NumSides();
    return count;
  }

  bool HasCrowdedEdge() const {
    for (uint32_t e = 0; e < adjacency_.NumEdges(); ++e)
      if (CountAt(e) > 2) return true;
    return false;
  }

  // Whether the edge joins two sides to one panel.
  bool Joins(uint32_t e) const {
    if (CountAt(e) != 2) return false;
    const auto faces = adjacency_.EdgeFaces(e);
    return faces.size() == 2 &&
           AwayFrom(e, faces[0]).dot(AwayFrom(e, faces[1])) < kFolded;
  }

  // The direction from the edge into the face; zero where it has no area.
  Eigen::Vector3d AwayFrom(uint32_t e, uint32_t f) const {
    const auto [first, last] = adjacency_.EdgeVertices(e);
    const Triangle& face = mesh_.faces[f];
    const uint32_t top = face[0] ^ face[1] ^ face[2] ^ first ^ last;
    const auto from_first = [&, v = first](uint32_t x) -> Eigen::Vector3d {
      return (unit_.row(x) - unit_.row(v)).transpose();
    };
    const Eigen::Vector3d along = from_first(last).stableNormalized();
    const Eigen::Vector3d up = from_first(top);
    return (up - up.dot(along) * along).stableNormalized();
  }

  absl::Status FindBorders() {
    const auto join = [&](uint32_t e) {
      if (!Joins(e)) return;
      uint32_t first = kNoIndex;
      ForEachSideAt(e, [&](uint32_t side, bool) {
        if (first == kNoIndex) first = side;
        panels_.Union(first, side);
      });
    };
    MARROW_RETURN_IF_ERROR(ForEachIndex(adjacency_.NumEdges(), cancel_, join));
    const auto end = [&](uint32_t e) {
      if (Joins(e)) return;
      const bool is_open = CountAt(e) == 1;
      ForEachSideAt(e, [&](uint32_t side, bool forward) {
        borders_.push_back({panels_.Find(side), e, forward, is_open});
      });
    };
    MARROW_RETURN_IF_ERROR(ForEachIndex(adjacency_.NumEdges(), cancel_, end));
    return SortUnlessCancelled(
        borders_.begin(), borders_.end(),
        [](const Border& a, const Border& b) {
          return std::tie(a.panel, a.edge) < std::tie(b.panel, b.edge);
        },
        cancel_);
  }

  // Of the panels that may be of a wall: neither open nor on both sides of an
  // edge.
  std::vector<Borders> CandidateBorders() const {
    std::vector<Borders> candidates;
    for (auto run = borders_.begin(); run != borders_.end();) {
      const auto end = std::find_if(run, borders_.end(), [&](const Border& b) {
        return b.panel != run->panel;
      });
      const bool open =
          std::any_of(run, end, [](const Border& b) { return b.is_open; });
      const bool twice =
          std::adjacent_find(run, end, [](const Border& a, const Border& b) {
            return a.edge == b.edge;
          }) != end;
      if (!open && !twice) candidates.emplace_back(run, end);
      run = end;
    }
    return candidates;
  }

  static bool IsBefore(const Borders& a, const Borders& b) {
    return std::lexicographical_compare(
        a.begin(), a.end(), b.begin(), b.end(),
        [](const Border& x, const Border& y) { return x.edge < y.edge; });
  }

  static bool AreOpposite(const Borders& a, const Borders& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Border& x, const Border& y) {
                        return x.edge == y.edge && x.forward != y.forward;
                      });
  }

  // Numbers the walls, by panel.
  absl::Status PairPanels() {
    std::vector<Borders> candidates = CandidateBorders();
    MARROW_RETURN_IF_ERROR(SortUnlessCancelled(
        candidates.begin(), candidates.end(), IsBefore, cancel_));
    partner_.assign(2 * size_t{mesh_.NumFaces()}, kNoIndex);
    for (auto run = candidates.begin(); run != candidates.end();) {
      const auto end = std::upper_bound(run, candidates.end(), *run, IsBefore);
      if (end - run == 2 && AreOpposite(run[0], run[1])) {
        partner_[run[0].front().panel] = run[1].front().panel;
        partner_[run[1].front().panel] = run[0].front().panel;
      }
      run = end;
    }
    return NumberFlatPairs();
  }

  // The sides of a panel and its partner.
  using Pair = std::vector<uint32_t>;

  absl::Status NumberFlatPairs() {
    std::vector<uint32_t> pair_of(partner_.size(), kNoIndex);  // lesser panel
    std::vector<Pair> pairs;
    const auto gather = [&](uint32_t side) {
      const uint32_t panel = panels_.Find(side);
      if (!Exists(side) || partner_[panel] == kNoIndex) return;
      uint32_t& pair = pair_of[std::min(panel, partner_[panel])];
      if (pair == kNoIndex) {
        pair = static_cast<uint32_t>(pairs.size());
        pairs.emplace_back();
      }
      pairs[pair].push_back(side);
    };
    MARROW_RETURN_IF_ERROR(ForEachIndex(partner_.size(), cancel_, gather));
    wall_of_side_.assign(partner_.size(), kNoIndex);
    return ForEachIndex(pairs.size(), cancel_, [&](size_t i) {
      if (!IsFlat(pairs[i])) return;
      for (uint32_t side : pairs[i]) wall_of_side_[side] = num_walls_;
      ++num_walls_;
    });
  }

  // Whether all lies in one plane, that of the largest face.
  bool IsFlat(const Pair& pair) const {
    if (pair.size() == 2 && pair[0] / 2 == pair[1] / 2) return true;
    const Eigen::Vector3d origin =
        unit_.row(mesh_.faces[pair[0] / 2][0]).transpose();
    double extent = 0;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    const auto from_origin = [&](uint32_t side, int i) -> Eigen::Vector3d {
      return unit_.row(mesh_.faces[side / 2][i]).transpose() - origin;
    };
    for (uint32_t side : pair) {
      const Eigen::Vector3d p = from_origin(side, 0);
      const Eigen::Vector3d n =
          (from_origin(side, 1) - p).cross(from_origin(side, 2) - p);
      if (n.squaredNorm() > normal.squaredNorm()) normal = n;
      for (int i = 0; i < 3; ++i)
        extent = std::max(extent, from_origin(side, i).norm());
    }
    if (normal.isZero(0)) return false;
    normal.stableNormalize();
    const auto leaves = [&](uint32_t side) {
      for (int i = 0; i < 3; ++i)
        if (std::abs(normal.dot(from_origin(side, i))) > kFlat * extent)
          return true;
      return false;
    };
    return std::none_of(pair.begin(), pair.end(), leaves);
  }

  // 1 or -1: whether the faces of the payload look outwards or inwards, all in
  // all.
  double Outwards() const {
    const Eigen::RowVector3d center = unit_.colwise().mean();
    double volume = 0;
    for (uint32_t f = 0; f < mesh_.NumFaces(); ++f) {
      const auto from_center = [&](int i) -> Eigen::Vector3d {
        return (unit_.row(mesh_.faces[f][i]) - center).transpose();
      };
      const double of_face =
          from_center(0).dot(from_center(1).cross(from_center(2)));
      for (uint32_t side : {2 * f, 2 * f + 1})
        if (Exists(side)) volume += Descends(side) ? -of_face : of_face;
    }
    return volume < 0 ? -1 : 1;
  }

  // As the payload has the side turned.
  Eigen::Vector3d Normal(uint32_t side) const {
    const Triangle& face = mesh_.faces[side / 2];
    const auto to = [&](int i) -> Eigen::Vector3d {
      return (unit_.row(face[i]) - unit_.row(face[0])).transpose();
    };
    const Eigen::Vector3d normal = to(1).cross(to(2)).stableNormalized();
    return Descends(side) ? -normal : normal;
  }

  // Whether the walls at an edge lie behind two other sides there, as what is
  // inside does: none before either, and each behind one.
  bool AreBehind(uint32_t e, const std::vector<uint32_t>& walls,
                 const std::vector<uint32_t>& others, double outwards) const {
    const std::array<Eigen::Vector3d, 2> normals = {
        outwards * Normal(others[0]), outwards * Normal(others[1])};
    return std::all_of(walls.begin(), walls.end(), [&](uint32_t side) {
      const Eigen::Vector3d away = AwayFrom(e, side / 2);
      const auto [least, most] =
          std::minmax({normals[0].dot(away), normals[1].dot(away)});
      return most < kLevel && least < -kLevel;
    });
  }

  // Takes out of wall_of_side_ the walls without which the surface would not be
  // closed, and those that are outside.
  absl::Status KeepWallsUnlessInside() {
    DisjointSets groups(num_walls_);
    std::vector<bool> may_go(num_walls_, true);
    std::vector<bool> is_held(num_walls_, false);
    const double outwards = Outwards();
    std::vector<uint32_t> walls;
    std::vector<uint32_t> others;
    const auto look = [&](uint32_t e) {
      walls.clear();
      others.clear();
      ForEachSideAt(e, [&](uint32_t side, bool) {
        (wall_of_side_[side] == kNoIndex ? others : walls).push_back(side);
      });
      if (walls.empty() || Joins(e)) return;
      const uint32_t first = wall_of_side_[walls[0]];
      for (uint32_t side : walls) groups.Union(first, wall_of_side_[side]);
      if (others.size() == 1 || (others.empty() && walls.size() == 2) ||
          (others.size() == 2 && !AreBehind(e, walls, others, outwards)))
        may_go[first] = false;
      if (others.size() == 2) is_held[first] = true;
    };
    MARROW_RETURN_IF_ERROR(ForEachIndex(adjacency_.NumEdges(), cancel_, look));
    for (uint32_t wall = 0; wall < num_walls_; ++wall) {
      const uint32_t group = groups.Find(wall);
      if (!may_go[wall]) may_go[group] = false;
      if (is_held[wall]) is_held[group] = true;
    }
    for (uint32_t& wall : wall_of_side_) {
      if (wall == kNoIndex) continue;
      const uint32_t group = groups.Find(wall);
      if (!may_go[group] || !is_held[group]) wall = kNoIndex;
    }
    if (std::all_of(wall_of_side_.begin(), wall_of_side_.end(),
                    [](uint32_t wall) { return wall == kNoIndex; })) {
      outside_.clear();
    } else {
      outside_.assign(wall_of_side_.size(), kNoIndex);
    }
    return absl::OkStatus();
  }

  // Spreads from the faces around over the walls that are not reached yet, to
  // sides that agree or to any.
  absl::Status FindOutside(bool agreeing) {
    if (outside_.empty()) return absl::OkStatus();
    std::vector<std::array<bool, 2>> done(adjacency_.NumEdges());
    std::vector<uint32_t> front;
    const auto reach = [&](uint32_t e, bool forward, uint32_t face) {
      bool& is_done = done[e][agreeing && forward];
      if (is_done) return;
      is_done = true;
      ForEachSideAt(e, [&](uint32_t side, bool runs) {
        if (wall_of_side_[side] == kNoIndex || outside_[side] != kNoIndex ||
            (agreeing && runs == forward))
          return;
        outside_[side] = face;
        front.push_back(side);
      });
    };
    const auto begin = [&](uint32_t e) {
      ForEachSideAt(e, [&](uint32_t side, bool forward) {
        if (wall_of_side_[side] == kNoIndex)
          reach(e, forward, side / 2);
        else if (!agreeing && outside_[side] != kNoIndex)
          reach(e, forward, outside_[side]);
      });
    };
    MARROW_RETURN_IF_ERROR(ForEachIndex(adjacency_.NumEdges(), cancel_, begin));
    for (size_t i = 0; i < front.size(); ++i) {
      const uint32_t f = front[i] / 2;
      for (uint32_t e : adjacency_.FaceEdges(f)) {
        const auto [v, w] = adjacency_.EdgeVertices(e);
        const bool forward =
            RunsAlong(mesh_.faces[f], v, w) != Descends(front[i]);
        reach(e, forward, outside_[front[i]]);
      }
    }
    return cancel_.Check();
  }

  const TriangleMesh& mesh_;
  const Adjacency& adjacency_;
  const std::vector<Directions>& directions_;
  const CancelToken& cancel_;
  DisjointSets panels_;  // of sides
  Positions unit_;
  std::vector<Border> borders_;
  std::vector<uint32_t> partner_;       // panel -> the other of a pair
  std::vector<uint32_t> wall_of_side_;  // the pairs that are flat
  uint32_t num_walls_ = 0;
  std::vector<uint32_t> outside_;
};

}  // namespace

absl::StatusOr<std::vector<uint32_t>> FindInnerWalls(
    const TriangleMesh& mesh, const Adjacency& adjacency,
    const std::vector<Directions>& directions, const CancelToken& cancel) {
  return WallFinder(mesh, adjacency, directions, cancel).Find();
}

}  // namespace marrow
