#include "core/mesh/coarse_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "absl/container/inlined_vector.h"
#include "core/base/cancellable.h"
#include "core/mesh/mesh_report.h"
#include "core/mesh/place_factors.h"
#include "core/mesh/unit_box.h"

namespace marrow {
namespace {

// A vertex of more faces is neither taken away nor grown: checking an edge
// takes the square of its ends' faces.
constexpr size_t kMostFaces = 24;
// Of the vertices, those with the shortest edges go first: so many in a round.
constexpr double kShareARound = 0.5;
// Rounds that take away less are not worth their while, nor are more of them.
constexpr double kLeastGain = 0.03;
constexpr int kMostRounds = 50;
// The two ends of a shortest edge always tie, and on a subdivided mesh many
// edges do. If numbers or rounding broke ties, a mesh that is turned or scaled
// would have another coarse mesh; so squared lengths are multiplied by numbers
// that go with the place, and differ by far more than a file's floats round.
constexpr double kSpread = 0.3;

// What may become of a face.
struct ShapeLimits {
  double cosine;  // of the most that it may be turned
  // Twice the area over the squared longest edge: 0.87 for an equilateral
  // triangle. Faces must not become worse than that, unless they were.
  double quality;

  bool operator==(const ShapeLimits&) const = default;
};
// The second where the first leaves too many vertices: on surfaces all of
// corners and holes. None is a number that the faces of a lattice have.
constexpr ShapeLimits kShapeLimits[] = {{0.51, 0.19}, {-0.49, 0.019}};

// A face that is bad already becomes worse below that share of its quality:
// those of a stretched lattice are equally bad but for rounding.
constexpr double kWorse = 0.99;

bool Has(const Triangle& face, uint32_t v) {
  return face[0] == v || face[1] == v || face[2] == v;
}

// The corners of a face beside one of them, in the order of the face.
std::pair<uint32_t, uint32_t> Others(const Triangle& face, uint32_t v) {
  if (face[0] == v) return {face[1], face[2]};
  if (face[1] == v) return {face[2], face[0]};
  return {face[0], face[1]};
}

// Entry i -> where following the entries ends.
void Follow(std::vector<uint32_t>& next) {
  for (uint32_t i = 0; i < next.size(); ++i) {
    uint32_t end = i;
    while (next[end] != end) end = next[end];
    for (uint32_t at = i; at != end;) at = std::exchange(next[at], end);
  }
}

class Coarsener {
 public:
  explicit Coarsener(const TriangleMesh& mesh)
      : mesh_(mesh),
        unit_(mesh.positions * UnitScale(mesh)),
        corners_(mesh.faces),
        live_(mesh.NumFaces()),
        gone_(mesh.NumVertices(), false),
        stuck_(mesh.NumVertices(), false),
        locked_(mesh.NumVertices(), false),
        factors_(PlaceFactors(mesh, kSpread)),
        heir_(mesh.NumFaces()),
        num_vertices_(mesh.NumVertices()) {
    std::iota(live_.begin(), live_.end(), 0u);
    std::iota(heir_.begin(), heir_.end(), 0u);
  }

  uint32_t num_vertices() const { return num_vertices_; }

  // Takes away vertices that are no neighbours of each other, down to `least`.
  absl::Status Round(uint32_t least, const ShapeLimits& limits,
                     const CancelToken& cancel) {
    if (limits != limits_) stuck_.assign(stuck_.size(), false);
    limits_ = limits;
    Unstick();
    MARROW_RETURN_IF_ERROR(cancel.Check());
    GatherStars();
    MARROW_RETURN_IF_ERROR(cancel.Check());
    locked_.assign(mesh_.NumVertices(), false);
    MARROW_ASSIGN_OR_RETURN(const std::vector<uint32_t> order,
                            ShortestFirst(cancel));
    for (uint32_t u : order) {
      if (num_vertices_ <= least) break;
      MARROW_RETURN_IF_ERROR(cancel.Check());
      if (!locked_[u] && !stuck_[u]) TryCollapse(u);
    }
    std::erase_if(live_, [&](uint32_t f) { return heir_[f] != f; });
    return absl::OkStatus();
  }

  absl::StatusOr<CoarseMesh> Take(const CancelToken& cancel) {
    CoarseMesh result;
    TriangleMesh& coarse = result.canonical.mesh;
    coarse.positions.resize(num_vertices_, 3);
    std::vector<uint32_t> own(mesh_.NumVertices(), kNoIndex);
    for (uint32_t v = 0; v < own.size(); ++v) {
      if (gone_[v]) continue;
      own[v] = static_cast<uint32_t>(result.vertices.size());
      coarse.positions.row(own[v]) = mesh_.positions.row(v);
      result.vertices.push_back(v);
    }
    MARROW_RETURN_IF_ERROR(TakeFaces(own, cancel, result));
    result.canonical.report = ReportOn(coarse, cancel);
    MARROW_RETURN_IF_ERROR(cancel.Check());
    result.canonical.geometry_digest = GeometryDigestOf(coarse);
    return result;
  }

 private:
  using Ring = absl::InlinedVector<uint32_t, kMostFaces + 1>;

  std::span<const uint32_t> Star(uint32_t v) const {
    return {star_.data() + offsets_[v], offsets_[v + 1] - offsets_[v]};
  }

  // The live faces at each vertex.
  void GatherStars() {
    offsets_.assign(mesh_.NumVertices() + 1, 0);
    for (uint32_t f : live_)
      for (uint32_t v : corners_[f]) ++offsets_[v + 1];
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    star_.resize(3 * live_.size());
    std::vector<uint32_t> end(offsets_.begin(), offsets_.end() - 1);
    for (uint32_t f : live_)
      for (uint32_t v : corners_[f]) star_[end[v]++] = f;
  }

  double SquaredLength(uint32_t a, uint32_t b) const {
    return (unit_.row(a) - unit_.row(b)).squaredNorm();
  }

  // The vertices with the shortest edges, by these.
  absl::StatusOr<std::vector<uint32_t>> ShortestFirst(
      const CancelToken& cancel) const {
    std::vector<double> shortest(mesh_.NumVertices(),
                                 std::numeric_limits<double>::infinity());
    for (uint32_t f : live_)
      for (int i = 0; i < 3; ++i) {
        const uint32_t a = corners_[f][i], b = corners_[f][(i + 1) % 3];
        const double length = SquaredLength(a, b);
        shortest[a] = std::min(shortest[a], length);
        shortest[b] = std::min(shortest[b], length);
      }
    std::vector<std::pair<double, uint32_t>> order;
    order.reserve(num_vertices_);
    for (uint32_t v = 0; v < shortest.size(); ++v)
      if (!gone_[v]) order.push_back({factors_[v] * shortest[v], v});
    const auto middle =
        order.begin() + static_cast<size_t>(kShareARound * order.size());
    MARROW_RETURN_IF_ERROR(cancel.Check());
    std::nth_element(order.begin(), middle, order.end());
    MARROW_RETURN_IF_ERROR(
        SortUnlessCancelled(order.begin(), middle, std::less<>(), cancel));
    std::vector<uint32_t> vertices;
    vertices.reserve(middle - order.begin());
    for (auto it = order.begin(); it != middle; ++it)
      vertices.push_back(it->second);
    return vertices;
  }

  // What a vertex may do hangs on the faces at it and at its neighbours.
  void Unstick() {
    for (uint32_t f : live_) {
      const Triangle& face = corners_[f];
      if (locked_[face[0]] || locked_[face[1]] || locked_[face[2]])
        for (uint32_t v : face) stuck_[v] = false;
    }
  }

  // Into the nearest neighbour that allows it. Stuck, unless a later round may
  // find otherwise.
  void TryCollapse(uint32_t u) {
    stuck_[u] = true;
    if (Star(u).size() > kMostFaces) return;
    const Ring ring = RingOf(u);
    Ring ends;  // of boundary edges
    for (uint32_t v : ring)
      if (CountShared(u, v) == 1) ends.push_back(v);
    if (!IsFan(u, ring, ends.size())) return;
    std::vector<std::pair<double, uint32_t>> near;
    for (uint32_t v : ends.empty() ? ring : ends)
      if (!locked_[v] && Star(v).size() <= kMostFaces)
        near.push_back({factors_[v] * SquaredLength(u, v), v});
    std::sort(near.begin(), near.end());
    for (const auto& [length, v] : near) {
      if (!ShapesHold(u, v) || !LinkHolds(u, v, ring)) continue;
      Collapse(u, v, ring);
      return;
    }
  }

  // Its neighbours, ascending.
  Ring RingOf(uint32_t u) const {
    Ring ring;
    for (uint32_t f : Star(u))
      for (uint32_t v : corners_[f])
        if (v != u) ring.push_back(v);
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    return ring;
  }

  size_t CountShared(uint32_t u, uint32_t v) const {
    size_t count = 0;
    for (uint32_t f : Star(u)) count += Has(corners_[f], v);
    return count;
  }

  bool IsNeighbour(uint32_t u, uint32_t v) const {
    return std::ranges::any_of(Star(u),
                               [&](uint32_t f) { return Has(corners_[f], v); });
  }

  // Whether the faces around u are one fan, closed or with two ends.
  bool IsFan(uint32_t u, const Ring& ring, size_t num_ends) const {
    const std::span<const uint32_t> star = Star(u);
    if (star.size() < 2 || (num_ends != 0 && num_ends != 2)) return false;
    for (uint32_t v : ring)
      if (CountShared(u, v) > 2) return false;
    Ring reached{star[0]};
    for (size_t i = 0; i < reached.size(); ++i) {
      const auto [a, b] = Others(corners_[reached[i]], u);
      for (uint32_t f : star)
        if ((Has(corners_[f], a) || Has(corners_[f], b)) &&
            std::find(reached.begin(), reached.end(), f) == reached.end())
          reached.push_back(f);
    }
    return reached.size() == star.size();
  }

  // Whether collapsing u into v keeps the topology. REQUIRES: a fan around u;
  // where it has ends, v is one.
  bool LinkHolds(uint32_t u, uint32_t v, const Ring& ring) const {
    const size_t shared = CountShared(u, v);
    if (shared == Star(u).size()) return false;
    size_t common = 0;
    for (uint32_t w : ring) common += w != v && IsNeighbour(v, w);
    if (common != shared) return false;
    // Nor may a face come to lie on another.
    for (uint32_t f : Star(u)) {
      if (Has(corners_[f], v)) continue;
      const auto [a, b] = Others(corners_[f], u);
      for (uint32_t g : Star(v))
        if (Has(corners_[g], a) && Has(corners_[g], b)) return false;
    }
    return true;
  }

  bool ShapesHold(uint32_t u, uint32_t v) const {
    for (uint32_t f : Star(u)) {
      if (Has(corners_[f], v)) continue;
      const auto [a, b] = Others(corners_[f], u);
      const Eigen::Vector3d before = DoubledArea(u, a, b);
      const Eigen::Vector3d after = DoubledArea(v, a, b);
      const double norms = before.norm() * after.norm();
      if (norms > 0 && before.dot(after) < limits_.cosine * norms) return false;
      const double quality = Quality(after.norm(), v, a, b);
      if (quality < limits_.quality &&
          quality < kWorse * Quality(before.norm(), u, a, b))
        return false;
    }
    return true;
  }

  Eigen::Vector3d DoubledArea(uint32_t a, uint32_t b, uint32_t c) const {
    const Eigen::Vector3d to_b = (unit_.row(b) - unit_.row(a)).transpose();
    return to_b.cross((unit_.row(c) - unit_.row(a)).transpose());
  }

  double Quality(double doubled_area, uint32_t a, uint32_t b,
                 uint32_t c) const {
    return doubled_area / std::max({SquaredLength(a, b), SquaredLength(b, c),
                                    SquaredLength(c, a)});
  }

  // A face that goes joins the cluster of its neighbour across an edge of u's:
  // that one comes to be where both were.
  void Collapse(uint32_t u, uint32_t v, const Ring& ring) {
    for (uint32_t f : Star(u)) {
      if (!Has(corners_[f], v)) continue;
      const auto [a, b] = Others(corners_[f], u);
      heir_[f] = NeighbourAcross(f, u, a == v ? b : a);
    }
    for (uint32_t f : Star(u))
      if (heir_[f] == f)
        std::replace(corners_[f].begin(), corners_[f].end(), u, v);
    gone_[u] = true;
    --num_vertices_;
    locked_[u] = true;
    for (uint32_t w : ring) locked_[w] = true;
  }

  uint32_t NeighbourAcross(uint32_t f, uint32_t u, uint32_t w) const {
    for (uint32_t g : Star(u))
      if (g != f && Has(corners_[g], w)) return g;
    return f;  // not in a fan of two faces or more whose end is not w
  }

  // `own` is the coarse number of each fine vertex that is left.
  absl::Status TakeFaces(const std::vector<uint32_t>& own,
                         const CancelToken& cancel, CoarseMesh& result) {
    Follow(heir_);
    MARROW_RETURN_IF_ERROR(cancel.Check());
    std::vector<std::pair<Triangle, uint32_t>> sorted;
    sorted.reserve(live_.size());
    for (uint32_t f : live_) {
      Triangle face = corners_[f];
      for (uint32_t& corner : face) corner = own[corner];
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()),
                  face.end());
      sorted.push_back({face, f});
    }
    MARROW_RETURN_IF_ERROR(SortUnlessCancelled(sorted.begin(), sorted.end(),
                                               std::less<>(), cancel));
    result.coarse_face.assign(mesh_.NumFaces(), kNoIndex);
    for (const auto& [corners, f] : sorted) {
      result.coarse_face[f] = static_cast<uint32_t>(result.faces.size());
      result.faces.push_back(f);
      result.canonical.mesh.faces.push_back(corners);
    }
    for (uint32_t f = 0; f < heir_.size(); ++f)
      result.coarse_face[f] = result.coarse_face[heir_[f]];
    return absl::OkStatus();
  }

  const TriangleMesh& mesh_;
  const Positions unit_;
  std::vector<Triangle> corners_;  // of each face, as collapsed so far
  std::vector<uint32_t> live_;     // faces that are left, ascending
  std::vector<bool> gone_;         // vertices
  std::vector<bool> stuck_;        // vertices that had nowhere to go
  std::vector<bool> locked_;       // a face at it changed in the last round
  std::vector<double> factors_;    // of vertices, to costs
  std::vector<uint32_t> heir_;     // face -> whose patch it joined, or itself
  uint32_t num_vertices_;
  // Of the round.
  ShapeLimits limits_{};
  std::vector<uint32_t> offsets_;
  std::vector<uint32_t> star_;
};

absl::StatusOr<CoarseMesh> CoarsenUnlessCancelled(const TriangleMesh& mesh,
                                                  uint32_t num_vertices,
                                                  const CancelToken& cancel) {
  Coarsener coarsener(mesh);
  for (const ShapeLimits& limits : kShapeLimits)
    for (int round = 0;
         round < kMostRounds && coarsener.num_vertices() > num_vertices;
         ++round) {
      const uint32_t before = coarsener.num_vertices();
      MARROW_RETURN_IF_ERROR(coarsener.Round(num_vertices, limits, cancel));
      if (before - coarsener.num_vertices() < kLeastGain * before) break;
    }
  return coarsener.Take(cancel);
}

}  // namespace

CoarseMesh Coarsen(const TriangleMesh& mesh, uint32_t num_vertices,
                   const CancelToken& cancel) {
  return CoarsenUnlessCancelled(mesh, num_vertices, cancel)
      .value_or(CoarseMesh());
}

}  // namespace marrow
