// Each front needs the distance of the vertices that it touches, and most
// vertices are touched by one front alone. So distances are computed when first
// asked for, about one a vertex however many fronts compete, and the first of a
// vertex is kept in an array: only those near where fronts meet take hashing.
#include "core/pieces/fronts.h"

#include <algorithm>
#include <limits>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "core/pieces/medial_structure.h"

namespace marrow {
namespace {

struct Candidate {
  double key;  // Eq. 11
  uint32_t face;
  uint32_t front;

  // Least first in a std::priority_queue.
  friend bool operator<(const Candidate& a, const Candidate& b) {
    return std::tie(a.key, a.face, a.front) > std::tie(b.key, b.face, b.front);
  }
};

class Competition {
 public:
  Competition(const Region& region, const MapSketch& sketch,
              const std::vector<Structure>& structures,
              std::vector<FrontDistance> known)
      : region_(region),
        known_(std::move(known)),
        pushed_by_(region.NumFaces(), kNoIndex),
        owner_(region.NumFaces(), kNoIndex) {
    known_.resize(region.NumVertices());
    for (const Structure& structure : structures)
      distances_.emplace_back(sketch, structure);
    for (uint32_t front = 0; front < structures.size(); ++front)
      for (uint32_t v : structures[front])
        for (uint32_t f : region_.adjacency().VertexFaces(v)) Push(f, front);
  }

  void Run(const CancelToken& cancel) {
    for (uint64_t steps = 0; !heap_.empty(); ++steps) {
      if (steps % 4096 == 0 && cancel.IsCancelled()) return;
      const Candidate next = heap_.top();
      heap_.pop();
      if (owner_[next.face] != kNoIndex) continue;
      owner_[next.face] = next.front;
      for (int i = 0; i < 3; ++i) Cross(next.face, i, next.front);
      for (const auto& [face, linked] : region_.LinksOf(next.face))
        Push(linked, next.front);
    }
    if (!cancel.IsCancelled()) ClaimUnreached();
  }

  std::vector<uint32_t> TakeOwners() { return std::move(owner_); }

 private:
  // An edge of k faces would be looked at k times for its k faces.
  void Cross(uint32_t face, int i, uint32_t front) {
    const uint32_t other = region_.Across(face)[i];
    if (other != kNoIndex) return Push(other, front);
    const uint32_t e = region_.adjacency().FaceEdges(face)[i];
    const auto faces = region_.adjacency().EdgeFaces(e);
    if (faces.size() > 2 && crossed_.emplace(e, front).second)
      for (uint32_t f : faces) Push(f, front);
  }

  // A candidate that is there already would only be popped in vain.
  void Push(uint32_t face, uint32_t front) {
    if (owner_[face] != kNoIndex || pushed_by_[face] == front) return;
    pushed_by_[face] = front;
    heap_.push({Key(face, front), face, front});
  }

  // A search begins at what is nearest to another corner.
  double Key(uint32_t face, uint32_t front) {
    uint32_t point = 0;
    for (uint32_t v : region_.triangles()[face])
      if (known_[v].front == front) point = known_[v].point;
    double key = 0;
    for (uint32_t v : region_.triangles()[face])
      key = std::max(key, DistanceOf(v, front, point));
    return key;
  }

  double DistanceOf(uint32_t vertex, uint32_t front, uint32_t& point) {
    FrontDistance& first = known_[vertex];
    if (first.front == kNoIndex) {
      const double distance = distances_[front].From(point, vertex);
      first = {front, point, distance};
    }
    if (first.front == front) return first.distance;
    auto [it, is_new] = others_.try_emplace({vertex, front}, 0.0);
    if (is_new) it->second = distances_[front].From(point, vertex);
    return it->second;
  }

  void ClaimUnreached() {
    std::vector<uint32_t> unreached;
    for (uint32_t f = 0; f < region_.NumFaces(); ++f)
      if (owner_[f] == kNoIndex) unreached.push_back(f);
    if (unreached.empty()) return;
    const std::vector<uint32_t> piece = ConnectedPieces(
        region_.adjacency(), std::vector<uint32_t>(region_.NumFaces(), 0),
        region_.links());
    std::map<uint32_t, std::vector<uint32_t>> faces_of_piece;
    for (uint32_t f : unreached) faces_of_piece[piece[f]].push_back(f);
    for (const auto& [id, faces] : faces_of_piece) {
      const uint32_t front = NearestFront(faces);
      for (uint32_t f : faces) owner_[f] = front;
    }
  }

  uint32_t NearestFront(const std::vector<uint32_t>& faces) {
    uint32_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t front = 0; front < distances_.size(); ++front) {
      double greatest = 0;
      for (uint32_t f : faces) greatest = std::max(greatest, Key(f, front));
      if (greatest < least) {
        least = greatest;
        best = front;
      }
    }
    return best;
  }

  const Region& region_;
  std::vector<StructureDistance> distances_;
  std::vector<FrontDistance> known_;  // of each vertex, to the first front
  // (vertex, front) -> the distance to a further front; only looked up.
  absl::flat_hash_map<std::pair<uint32_t, uint32_t>, double> others_;
  std::vector<uint32_t> pushed_by_;  // the latest front, of each face
  absl::flat_hash_set<std::pair<uint32_t, uint32_t>> crossed_;  // edge, front
  std::priority_queue<Candidate> heap_;
  std::vector<uint32_t> owner_;
};

constexpr uint32_t kRange = 4096;

}  // namespace

void ForRanges(Team& team, uint32_t count, const CancelToken& cancel,
               const std::function<void(uint32_t, uint32_t)>& body) {
  const uint32_t ranges = (count + kRange - 1) / kRange;
  team.For(static_cast<int>(ranges), [&](int i) {
    if (cancel.IsCancelled()) return;
    const uint32_t first = i * kRange;
    body(first, std::min(count, first + kRange));
  });
}

std::vector<FrontDistance> DistancesTo(const MapSketch& sketch,
                                       const std::vector<Structure>& structures,
                                       const std::vector<uint32_t>& front,
                                       const CancelToken& cancel, Team& team) {
  std::vector<StructureDistance> distances;
  distances.reserve(structures.size());
  for (const Structure& structure : structures)
    distances.emplace_back(sketch, structure);
  std::vector<FrontDistance> result(front.size());
  const auto count = static_cast<uint32_t>(front.size());
  ForRanges(team, count, cancel, [&](uint32_t first, uint32_t end) {
    // Next to each other in number is near each other, mostly.
    std::vector<uint32_t> point(structures.size(), 0);
    for (uint32_t v = first; v < end; ++v) {
      uint32_t& nearest = point[front[v]];
      const double distance = distances[front[v]].From(nearest, v);
      result[v] = {front[v], nearest, distance};
    }
  });
  return result;
}

std::vector<uint32_t> CompeteFronts(const Region& region,
                                    const MapSketch& sketch,
                                    const std::vector<Structure>& structures,
                                    const CancelToken& cancel,
                                    std::vector<FrontDistance> known) {
  Competition competition(region, sketch, structures, std::move(known));
  competition.Run(cancel);
  return competition.TakeOwners();
}

}  // namespace marrow
