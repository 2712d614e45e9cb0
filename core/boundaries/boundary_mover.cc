#include "core/boundaries/boundary_mover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <utility>

#include "core/base/status_macros.h"
#include "core/boundaries/calibration.h"
#include "core/boundaries/flood.h"
#include "core/boundaries/min_cut.h"
#include "core/pieces/stray_pieces.h"

namespace marrow {
namespace {

using Pair = std::pair<uint32_t, uint32_t>;  // the lesser piece first

class Mover {
 public:
  Mover(const TriangleMesh& mesh, const Adjacency& adjacency,
        const FaceLinks& links, const Curvature& curvature,
        std::vector<uint32_t>& piece_of_face)
      : adjacency_(adjacency),
        links_(links),
        curvature_(curvature),
        unit_(UnitAreaPositions(mesh)),
        flood_(mesh, adjacency, unit_),
        piece_(piece_of_face),
        node_(mesh.NumFaces(), kNoIndex) {}

  absl::Status MoveAll(uint32_t num_pieces, const CancelToken& cancel) {
    faces_.assign(num_pieces, {});
    for (uint32_t f = 0; f < piece_.size(); ++f) faces_[piece_[f]].push_back(f);
    for (const Pair& pair : Neighbours()) {
      MARROW_RETURN_IF_ERROR(cancel.Check());
      Move(pair);
    }
    return absl::OkStatus();
  }

 private:
  std::set<Pair> Neighbours() const {
    std::set<Pair> pairs;
    for (uint32_t e = 0; e < adjacency_.NumEdges(); ++e)
      for (uint32_t f : adjacency_.EdgeFaces(e))
        for (uint32_t g : FewNeighbours(e, f))
          if (piece_[f] < piece_[g]) pairs.insert({piece_[f], piece_[g]});
    return pairs;
  }

  // Those of f across edge e: where many faces meet, the next and the last one
  // stand for all, or the work would grow with the square of their number.
  std::vector<uint32_t> FewNeighbours(uint32_t e, uint32_t f) const {
    const std::span<const uint32_t> around = adjacency_.EdgeFaces(e);
    if (around.size() < 2) return {};
    const size_t i =
        std::lower_bound(around.begin(), around.end(), f) - around.begin();
    const uint32_t next = around[(i + 1) % around.size()];
    const uint32_t last = around[(i + around.size() - 1) % around.size()];
    return next == last ? std::vector<uint32_t>{next}
                        : std::vector<uint32_t>{next, last};
  }

  void Move(const Pair& pair) {
    const auto [a, b] = pair;
    const std::vector<uint32_t> boundary = BoundaryOf(pair);
    double length = 0;
    for (uint32_t e : boundary) length += Length(e);
    radius_ = length / (2 * std::numbers::pi);
    if (!(radius_ > 0)) return;
    band_.clear();
    if (!AddBand(boundary, a) || !AddBand(boundary, b)) return;
    for (uint32_t i = 0; i < band_.size(); ++i) node_[band_[i]] = i;
    Cut(pair);
    for (uint32_t f : band_) node_[f] = kNoIndex;
  }

  std::vector<uint32_t> BoundaryOf(const Pair& pair) const {
    const auto [a, b] = pair;
    const bool few = faces_[a].size() < faces_[b].size();
    const uint32_t own = few ? a : b, other = few ? b : a;
    std::vector<uint32_t> edges;
    for (uint32_t f : faces_[own])
      for (uint32_t e : adjacency_.FaceEdges(f))
        for (uint32_t g : FewNeighbours(e, f))
          if (piece_[g] == other) edges.push_back(e);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }

  // Whether something of the piece is left outside of the band.
  bool AddBand(const std::vector<uint32_t>& boundary, uint32_t piece) {
    const double limit = kBandWidth * radius_;
    flood_.Run(boundary, limit / kBandShare,
               [&](uint32_t f) { return piece_[f] == piece; });
    const double breadth = std::min(limit, kBandShare * flood_.farthest());
    const size_t before = band_.size();
    for (uint32_t f : flood_.faces())
      if (flood_.DistanceOf(f) < breadth) band_.push_back(f);
    return band_.size() - before < faces_[piece].size();
  }

  void Cut(const Pair& pair) {
    MinCut graph(static_cast<uint32_t>(band_.size()));
    for (uint32_t f : band_) {
      for (uint32_t e : adjacency_.FaceEdges(f))
        for (uint32_t g : FewNeighbours(e, f)) Connect(pair, f, g, e, graph);
      for (uint32_t g : links_.Of(f))
        Connect(pair, f, g, adjacency_.FaceEdges(std::min(f, g))[0], graph);
    }
    const std::vector<MinCut::Side> sides = graph.Solve();
    for (uint32_t i = 0; i < band_.size(); ++i)
      if (sides[i] != MinCut::Side::kNeither)
        piece_[band_[i]] =
            sides[i] == MinCut::Side::kSource ? pair.first : pair.second;
    ShareOut(pair);
  }

  // An edge within the band is connected from its lesser face alone.
  void Connect(const Pair& pair, uint32_t f, uint32_t g, uint32_t e,
               MinCut& graph) const {
    if (node_[g] != kNoIndex) {
      if (f < g) graph.Connect(node_[f], node_[g], Cost(e));
    } else if (piece_[g] == pair.first) {
      graph.ConnectToSource(node_[f], Cost(e));
    } else if (piece_[g] == pair.second) {
      graph.ConnectToSink(node_[f], Cost(e));
    }
  }

  // Brings the two lists of faces up to date.
  void ShareOut(const Pair& pair) {
    std::vector<uint32_t> both = std::move(faces_[pair.first]);
    both.insert(both.end(), faces_[pair.second].begin(),
                faces_[pair.second].end());
    faces_[pair.first].clear();
    faces_[pair.second].clear();
    for (uint32_t f : both) faces_[piece_[f]].push_back(f);
  }

  double Length(uint32_t e) const {
    const auto [u, v] = adjacency_.EdgeVertices(e);
    return (unit_.row(u) - unit_.row(v)).norm();
  }
  double Cost(uint32_t e) const {
    const auto [u, v] = adjacency_.EdgeVertices(e);
    const double width = kCreaseWidth * radius_;
    const double K = (curvature_.At(u, width) + curvature_.At(v, width)) / 2;
    const double bend = std::tanh(K * radius_ * radius_ / kCreaseCurvature);
    return Length(e) * (1 + kCreaseDiscount * bend);
  }

  const Adjacency& adjacency_;
  const FaceLinks& links_;
  const Curvature& curvature_;
  const Positions unit_;
  Flood flood_;
  std::vector<uint32_t>& piece_;
  std::vector<std::vector<uint32_t>> faces_;  // of each piece
  // Of the pair at hand.
  double radius_ = 0;
  std::vector<uint32_t> band_;
  std::vector<uint32_t> node_;  // face -> its place in the band
};

// Both ways, as JoinStrayPieces takes them.
std::vector<std::array<uint32_t, 2>> LinkPairs(const FaceLinks& links,
                                               uint32_t num_faces) {
  std::vector<std::array<uint32_t, 2>> pairs;
  if (links.empty()) return pairs;
  for (uint32_t f = 0; f < num_faces; ++f)
    for (uint32_t g : links.Of(f)) pairs.push_back({f, g});
  return pairs;
}

}  // namespace

absl::Status MoveBoundaries(const TriangleMesh& mesh,
                            const Adjacency& adjacency,
                            const std::vector<double>& face_areas,
                            const FaceLinks& links, const Curvature& curvature,
                            const CancelToken& cancel,
                            std::vector<uint32_t>& piece_of_face) {
  const uint32_t num_pieces =
      *std::max_element(piece_of_face.begin(), piece_of_face.end()) + 1;
  const auto pairs = LinkPairs(links, mesh.NumFaces());
  Mover mover(mesh, adjacency, links, curvature, piece_of_face);
  for (int pass = 0; pass < kMovePasses; ++pass) {
    MARROW_RETURN_IF_ERROR(mover.MoveAll(num_pieces, cancel));
    JoinStrayPieces(adjacency, face_areas, pairs, num_pieces, piece_of_face);
  }
  return absl::OkStatus();
}

}  // namespace marrow
