// Each front needs the distance of the vertices that it touches, and most
// vertices are touched by one front or two. So distances are computed when
// first asked for: the cost is about one distance a vertex, however many fronts
// compete.
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
  Competition(const Region& region, const DiffusionMap& Phi,
              const std::vector<Structure>& structures)
      : region_(region), owner_(region.NumFaces(), kNoIndex) {
    known_.resize(structures.size());
    for (const Structure& structure : structures)
      distances_.emplace_back(Phi, structure);
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
      for (uint32_t e : region_.adjacency().FaceEdges(next.face))
        if (FirstCrossing(e, next.front))
          for (uint32_t f : region_.adjacency().EdgeFaces(e))
            Push(f, next.front);
      for (const auto& [face, linked] : region_.LinksOf(next.face))
        Push(linked, next.front);
    }
    if (!cancel.IsCancelled()) ClaimUnreached();
  }

  std::vector<uint32_t> TakeOwners() { return std::move(owner_); }

 private:
  // An edge of k faces would be looked at k times for its k faces.
  bool FirstCrossing(uint32_t edge, uint32_t front) {
    return region_.adjacency().EdgeFaces(edge).size() <= 2 ||
           crossed_.emplace(edge, front).second;
  }

  void Push(uint32_t face, uint32_t front) {
    if (owner_[face] == kNoIndex) heap_.push({Key(face, front), face, front});
  }

  double Key(uint32_t face, uint32_t front) {
    double key = 0;
    for (uint32_t v : region_.triangles()[face])
      key = std::max(key, DistanceOf(v, front));
    return key;
  }

  double DistanceOf(uint32_t vertex, uint32_t front) {
    auto [it, is_new] = known_[front].try_emplace(vertex, 0.0);
    if (is_new) it->second = distances_[front](vertex);
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
  // A front's distances so far; only looked up, never iterated.
  std::vector<absl::flat_hash_map<uint32_t, double>> known_;
  absl::flat_hash_set<std::pair<uint32_t, uint32_t>> crossed_;  // edge, front
  std::priority_queue<Candidate> heap_;
  std::vector<uint32_t> owner_;
};

}  // namespace

std::vector<uint32_t> CompeteFronts(const Region& region,
                                    const DiffusionMap& Phi,
                                    const std::vector<Structure>& structures,
                                    const CancelToken& cancel) {
  Competition competition(region, Phi, structures);
  competition.Run(cancel);
  return competition.TakeOwners();
}

}  // namespace marrow
