#include "core/boundaries/boundary_mover.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <span>
#include <utility>

#include "absl/container/inlined_vector.h"
#include "core/base/status_macros.h"
#include "core/boundaries/calibration.h"
#include "core/boundaries/flood.h"
#include "core/boundaries/min_cut.h"
#include "core/boundaries/pair_order.h"
#include "core/pieces/stray_pieces.h"
#include "core/spectrum/team.h"

namespace marrow {
namespace {

// Whose face is whose. Pairs of pieces that are moved at once see each other's
// faces pass from piece to piece, but never to or from their own two, which is
// all they ask.
class Pieces {
 public:
  Pieces(uint32_t count, std::vector<uint32_t>& of_face)
      : of_face_(of_face), faces_(count) {
    for (uint32_t f = 0; f < of_face.size(); ++f)
      faces_[of_face[f]].push_back(f);
  }

  uint32_t Of(uint32_t face) const {
    return std::atomic_ref(of_face_[face]).load(std::memory_order_relaxed);
  }
  void Put(uint32_t face, uint32_t piece) {
    std::atomic_ref(of_face_[face]).store(piece, std::memory_order_relaxed);
  }

  const std::vector<uint32_t>& Faces(uint32_t piece) const {
    return faces_[piece];
  }
  // Brings the lists of the two up to date.
  void ShareOut(const PiecePair& pair) {
    const auto [a, b] = pair;
    std::vector<uint32_t> both = std::move(faces_[a]);
    both.insert(both.end(), faces_[b].begin(), faces_[b].end());
    faces_[a].clear();
    faces_[b].clear();
    for (uint32_t f : both) faces_[Of(f)].push_back(f);
  }

 private:
  std::vector<uint32_t>& of_face_;
  std::vector<std::vector<uint32_t>> faces_;  // of each piece
};

// What boundaries are moved on, and how.
struct Surface {
  const TriangleMesh& mesh;
  const Adjacency& adjacency;
  const FaceLinks& links;
  const Curvature* curvature;  // null where short cuts are all that is wanted
  double band_width;           // in radii of the boundary
  double most_breadth;
  const Positions unit = UnitAreaPositions(mesh);

  double Length(uint32_t e) const {
    const auto [u, v] = adjacency.EdgeVertices(e);
    return (unit.row(u) - unit.row(v)).norm();
  }
};

// Those of f across edge e: where many faces meet, the next and the last one
// stand for all, or the work would grow with the square of their number.
absl::InlinedVector<uint32_t, 2> FewNeighbours(const Adjacency& adjacency,
                                               uint32_t e, uint32_t f) {
  const std::span<const uint32_t> around = adjacency.EdgeFaces(e);
  if (around.size() < 2) return {};
  if (around.size() == 2) return {around[around[0] == f]};
  const size_t i =
      std::lower_bound(around.begin(), around.end(), f) - around.begin();
  const uint32_t next = around[(i + 1) % around.size()];
  const uint32_t last = around[(i + around.size() - 1) % around.size()];
  return {next, last};
}

// Ascending.
std::vector<PiecePair> Neighbours(const Adjacency& adjacency,
                                  const std::vector<uint32_t>& piece_of_face) {
  std::set<PiecePair> pairs;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    for (uint32_t f : adjacency.EdgeFaces(e))
      for (uint32_t g : FewNeighbours(adjacency, e, f))
        if (piece_of_face[f] < piece_of_face[g])
          pairs.insert({piece_of_face[f], piece_of_face[g]});
  return {pairs.begin(), pairs.end()};
}

// Moves one boundary at a time; several movers may share the pieces.
class Mover {
 public:
  explicit Mover(const Surface& surface)
      : surface_(surface),
        flood_(surface.mesh, surface.adjacency, surface.unit),
        node_(surface.mesh.NumFaces(), kNoIndex) {}

  void Move(const PiecePair& pair, Pieces& pieces) {
    const std::vector<uint32_t> boundary = BoundaryOf(pair, pieces);
    double length = 0;
    for (uint32_t e : boundary) length += surface_.Length(e);
    radius_ = length / (2 * std::numbers::pi);
    if (!(radius_ > 0)) return;
    band_.clear();
    if (!AddBand(boundary, pair.first, pieces) ||
        !AddBand(boundary, pair.second, pieces))
      return;
    for (uint32_t i = 0; i < band_.size(); ++i) node_[band_[i]] = i;
    Cut(pair, pieces);
    for (uint32_t f : band_) node_[f] = kNoIndex;
  }

 private:
  std::vector<uint32_t> BoundaryOf(const PiecePair& pair,
                                   const Pieces& pieces) const {
    const auto [a, b] = pair;
    const bool few = pieces.Faces(a).size() < pieces.Faces(b).size();
    const uint32_t own = few ? a : b, other = few ? b : a;
    std::vector<uint32_t> edges;
    for (uint32_t f : pieces.Faces(own))
      for (uint32_t e : surface_.adjacency.FaceEdges(f))
        for (uint32_t g : FewNeighbours(surface_.adjacency, e, f))
          if (pieces.Of(g) == other) edges.push_back(e);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }

  // Whether something of the piece is left outside of the band.
  bool AddBand(const std::vector<uint32_t>& boundary, uint32_t piece,
               const Pieces& pieces) {
    const double limit =
        std::min(surface_.band_width * radius_, surface_.most_breadth);
    flood_.Run(boundary, limit / kBandShare,
               [&](uint32_t f) { return pieces.Of(f) == piece; });
    const double breadth = std::min(limit, kBandShare * flood_.farthest());
    const size_t before = band_.size();
    for (uint32_t f : flood_.faces())
      if (flood_.DistanceOf(f) < breadth) band_.push_back(f);
    return band_.size() - before < pieces.Faces(piece).size();
  }

  void Cut(const PiecePair& pair, Pieces& pieces) const {
    const Adjacency& adjacency = surface_.adjacency;
    MinCut graph(static_cast<uint32_t>(band_.size()));
    const auto connect = [&](uint32_t f, uint32_t g, uint32_t e) {
      Connect(pair, pieces, f, g, e, graph);
    };
    for (uint32_t f : band_) {
      for (uint32_t e : adjacency.FaceEdges(f))
        for (uint32_t g : FewNeighbours(adjacency, e, f)) connect(f, g, e);
      for (uint32_t g : surface_.links.Of(f))
        connect(f, g, adjacency.FaceEdges(std::min(f, g))[0]);
    }
    const std::vector<MinCut::Side> sides = graph.Solve();
    for (uint32_t i = 0; i < band_.size(); ++i)
      if (sides[i] != MinCut::Side::kNeither)
        pieces.Put(band_[i], sides[i] == MinCut::Side::kSource ? pair.first
                                                               : pair.second);
    pieces.ShareOut(pair);
  }

  // An edge within the band is connected from its lesser face alone.
  void Connect(const PiecePair& pair, const Pieces& pieces, uint32_t f,
               uint32_t g, uint32_t e, MinCut& graph) const {
    if (node_[g] != kNoIndex) {
      if (f < g) graph.Connect(node_[f], node_[g], Cost(e));
    } else if (pieces.Of(g) == pair.first) {
      graph.ConnectToSource(node_[f], Cost(e));
    } else if (pieces.Of(g) == pair.second) {
      graph.ConnectToSink(node_[f], Cost(e));
    }
  }

  double Cost(uint32_t e) const {
    if (surface_.curvature == nullptr) return surface_.Length(e);
    const auto [u, v] = surface_.adjacency.EdgeVertices(e);
    const Curvature& curvature = *surface_.curvature;
    const double width = kCreaseWidth * radius_;
    const double K = (curvature.At(u, width) + curvature.At(v, width)) / 2;
    const double bend = std::tanh(K * radius_ * radius_ / kCreaseCurvature);
    return surface_.Length(e) * (1 + kCreaseDiscount * bend);
  }

  const Surface& surface_;
  Flood flood_;
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

absl::Status Move(const Surface& surface, const std::vector<double>& face_areas,
                  int passes, const CancelToken& cancel,
                  std::vector<uint32_t>& piece_of_face) {
  const uint32_t num_pieces =
      *std::max_element(piece_of_face.begin(), piece_of_face.end()) + 1;
  const auto pairs = LinkPairs(surface.links, surface.mesh.NumFaces());
  Team team(UsualThreads());
  std::vector<Mover> movers;
  movers.reserve(team.threads());
  for (int i = 0; i < team.threads(); ++i) movers.emplace_back(surface);
  for (int pass = 0; pass < passes; ++pass) {
    Pieces pieces(num_pieces, piece_of_face);
    ForPairs(team, Neighbours(surface.adjacency, piece_of_face),
             [&](int worker, const PiecePair& pair) {
               if (!cancel.IsCancelled()) movers[worker].Move(pair, pieces);
             });
    MARROW_RETURN_IF_ERROR(cancel.Check());
    JoinStrayPieces(surface.adjacency, face_areas, pairs, num_pieces,
                    piece_of_face);
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status MoveBoundaries(const TriangleMesh& mesh,
                            const Adjacency& adjacency,
                            const std::vector<double>& face_areas,
                            const FaceLinks& links, const Curvature& curvature,
                            double band_width, const CancelToken& cancel,
                            std::vector<uint32_t>& piece_of_face) {
  const Surface surface{mesh,       adjacency,
                        links,      &curvature,
                        band_width, std::numeric_limits<double>::infinity()};
  return Move(surface, face_areas, kMovePasses, cancel, piece_of_face);
}

absl::Status SmoothBoundaries(const TriangleMesh& mesh,
                              const Adjacency& adjacency,
                              const std::vector<double>& face_areas,
                              const FaceLinks& links, double breadth,
                              const CancelToken& cancel,
                              std::vector<uint32_t>& piece_of_face) {
  const Surface surface{mesh, adjacency, links, nullptr, kBandWidth, breadth};
  return Move(surface, face_areas, 1, cancel, piece_of_face);
}

}  // namespace marrow
