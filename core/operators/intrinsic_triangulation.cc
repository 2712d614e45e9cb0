#include "core/operators/intrinsic_triangulation.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/operators/triangle_geometry.h"

namespace marrow {
namespace {

// A cotangent sum that is negative by less than this part of its terms is taken
// for zero: four points on a circle would else be flipped to and fro.
constexpr long double kRounding = 1e-13L;
constexpr uint32_t kCheckCancelEvery = 1 << 14;

uint32_t Next(uint32_t side) { return side % 3 == 2 ? side - 2 : side + 1; }
uint32_t Previous(uint32_t side) { return side % 3 == 0 ? side + 2 : side - 1; }

}  // namespace

IntrinsicTriangulation::IntrinsicTriangulation(GluedTriangles glued,
                                               const std::vector<Real>& lengths)
    : corners_(std::move(glued.corners)),
      side_edge_(corners_.size()),
      lengths_(corners_.size()),
      edge_sides_(std::move(glued.edges)) {
  for (uint32_t e = 0; e < edge_sides_.size(); ++e) {
    for (uint32_t side : edge_sides_[e]) {
      side_edge_[side] = e;
      lengths_[side] = lengths[glued.mesh_edge[e]];
    }
  }
}

IntrinsicTriangulation::Real IntrinsicTriangulation::Mollify(Real slack) {
  Real added = 0;
  for (uint32_t side = 0; side < corners_.size(); side += 3) {
    added = std::max(added,
                     slack - TriangleSlack(lengths_[side], lengths_[side + 1],
                                           lengths_[side + 2]));
  }
  if (added > 0)
    for (Real& length : lengths_) length += added;
  return added;
}

IntrinsicTriangulation::Corner IntrinsicTriangulation::OppositeCorner(
    uint32_t side) const {
  const Real a = lengths_[side], b = lengths_[Next(side)],
             c = lengths_[Previous(side)];
  return {ScaledCotangent(a, b, c), TriangleArea(a, b, c)};
}

bool IntrinsicTriangulation::IsDelaunay(uint32_t e) const {
  const auto [s, t] = edge_sides_[e];
  // Glued to itself, a triangle has two equal angles opposite, so acute ones.
  if (s / 3 == t / 3) return true;
  const Corner p = OppositeCorner(s), q = OppositeCorner(t);
  if (p.scaled_cotangent >= 0 && q.scaled_cotangent >= 0) return true;
  // The sum of cotangents times 4 p.area q.area, so that no area is divided by.
  const Real x = p.scaled_cotangent * q.area, y = q.scaled_cotangent * p.area;
  const Real scale = std::abs(x) + std::abs(y) + 4 * p.area * q.area;
  return x + y >= -kRounding * scale;
}

// The two triangles are laid out in the plane on either side of the edge.
IntrinsicTriangulation::Real IntrinsicTriangulation::LengthOfFlipped(
    uint32_t e) const {
  const auto [s, t] = edge_sides_[e];
  const Real base = lengths_[s];
  auto along = [&](Real opposite, Real adjacent) {
    return ScaledCotangent(opposite, base, adjacent) / (2 * base);
  };
  const Real x_s = along(lengths_[Next(s)], lengths_[Previous(s)]);
  const Real x_t = along(lengths_[Previous(t)], lengths_[Next(t)]);
  const Real heights =
      2 * (OppositeCorner(s).area + OppositeCorner(t).area) / base;
  return std::hypot(x_s - x_t, heights);
}

// Edge i -> j between apexes k and l becomes l -> k: triangles (i j k), (j i l)
// become (l k i), (k l j), each in the place of the old one.
void IntrinsicTriangulation::Flip(uint32_t e) {
  const Real length = LengthOfFlipped(e);
  const auto [s, t] = edge_sides_[e];
  const uint32_t k = corners_[Previous(s)], l = corners_[Previous(t)];
  const std::array<std::array<uint32_t, 2>, 4> moves = {
      {{Previous(s), Next(s)},    // k -> i
       {Next(t), Previous(s)},    // i -> l
       {Previous(t), Next(t)},    // l -> j
       {Next(s), Previous(t)}}};  // j -> k
  struct Moved {
    uint32_t to, corner, edge, end;
    Real length;
  };
  std::array<Moved, 4> moved;
  // All is read before any is written: two of the sides may be one edge.
  for (int i = 0; i < 4; ++i) {
    const auto [from, to] = moves[i];
    const uint32_t edge = side_edge_[from];
    moved[i] = {to, corners_[from], edge, edge_sides_[edge][1] == from,
                lengths_[from]};
  }
  for (const Moved& m : moved) {
    corners_[m.to] = m.corner;
    side_edge_[m.to] = m.edge;
    edge_sides_[m.edge][m.end] = m.to;
    lengths_[m.to] = m.length;
  }
  corners_[s] = l;
  corners_[t] = k;
  lengths_[s] = lengths_[t] = length;
}

absl::StatusOr<uint64_t> IntrinsicTriangulation::FlipToDelaunay(
    uint64_t max_flips, const CancelToken& cancel) {
  std::deque<uint32_t> queue(NumEdges());
  std::iota(queue.begin(), queue.end(), 0);
  std::vector<bool> is_queued(NumEdges(), true);
  uint64_t flips = 0;
  for (uint64_t steps = 0; !queue.empty(); ++steps) {
    if (steps % kCheckCancelEvery == 0 && cancel.IsCancelled())
      return cancel.Check();
    const uint32_t e = queue.front();
    queue.pop_front();
    is_queued[e] = false;
    if (IsDelaunay(e)) continue;
    if (flips == max_flips)
      return absl::ResourceExhaustedError(absl::StrCat(
          max_flips, " edge flips do not make the surface Delaunay"));
    Flip(e);
    ++flips;
    for (uint32_t side : edge_sides_[e]) {
      for (uint32_t other : {Next(side), Previous(side)}) {
        const uint32_t neighbour = side_edge_[other];
        if (is_queued[neighbour]) continue;
        is_queued[neighbour] = true;
        queue.push_back(neighbour);
      }
    }
  }
  return flips;
}

IntrinsicTriangulation::Real IntrinsicTriangulation::CotangentSum(
    uint32_t e) const {
  Real sum = 0;
  for (uint32_t side : edge_sides_[e]) {
    const Corner corner = OppositeCorner(side);
    sum += corner.scaled_cotangent / (4 * corner.area);
  }
  return sum;
}

std::vector<IntrinsicTriangulation::Edge>
IntrinsicTriangulation::WeightedEdges() const {
  std::vector<Edge> edges;
  edges.reserve(NumEdges());
  for (uint32_t e = 0; e < NumEdges(); ++e) {
    const uint32_t i = corners_[edge_sides_[e][0]];
    const uint32_t j = corners_[edge_sides_[e][1]];
    if (i == j) continue;
    const Real weight = std::max(Real(0), CotangentSum(e) / 2);
    edges.push_back({{i, j}, static_cast<double>(weight)});
  }
  return edges;
}

Eigen::VectorXd IntrinsicTriangulation::VertexAreas(uint32_t n) const {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(n);
  for (uint32_t side = 0; side < corners_.size(); side += 3) {
    const double third = static_cast<double>(OppositeCorner(side).area / 3);
    for (uint32_t i = 0; i < 3; ++i) areas[corners_[side + i]] += third;
  }
  return areas;
}

}  // namespace marrow
