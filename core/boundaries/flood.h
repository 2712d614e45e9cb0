// How far faces are from a boundary, over the surface.
#ifndef MARROW_CORE_BOUNDARIES_FLOOD_H_
#define MARROW_CORE_BOUNDARIES_FLOOD_H_

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Floods one mesh again and again from different edges, in the time of what is
// reached. Distances run along edges, in the unit of `positions`. Not thread
// safe. The referents must outlive it.
class Flood {
 public:
  Flood(const TriangleMesh& mesh, const Adjacency& adjacency,
        const Positions& positions);

  // Starts anew: from the ends of `edges`, over faces for which `within` holds,
  // up to vertices at distance `limit`.
  template <typename Within>  // bool(uint32_t face)
  void Run(std::span<const uint32_t> edges, double limit, const Within& within);

  // Of the last run: the faces with a vertex nearer than the limit, in the
  // order in which they were reached.
  const std::vector<uint32_t>& faces() const { return faces_; }
  // Mean distance of a reached face's corners.
  double DistanceOf(uint32_t face) const;
  // How much of a reached face is nearer than `distance`, 0 to 1: about, and
  // steadily, so that large faces do not make a difference.
  double ShareWithin(uint32_t face, double distance) const;
  // The greatest distance of a vertex, at most the limit.
  double farthest() const { return farthest_; }

 private:
  using Entry = std::pair<double, uint32_t>;

  // Together, for they are read together.
  struct Mark {
    uint32_t run = 0;  // the others count where this is run_
    double distance = 0;
  };

  // Whether the vertex is known to be that near.
  bool IsNear(uint32_t vertex, double distance) const {
    return marks_[vertex].run == run_ && marks_[vertex].distance <= distance;
  }
  void Reach(uint32_t vertex, double distance, double limit) {
    if (IsNear(vertex, distance)) return;
    marks_[vertex] = {run_, distance};
    if (distance >= limit) return;
    heap_.push_back({distance, vertex});
    std::push_heap(heap_.begin(), heap_.end(), std::greater<Entry>());
  }
  void Start(std::span<const uint32_t> edges, double limit);
  void FindFarthest(double limit);

  const TriangleMesh& mesh_;
  const Adjacency& adjacency_;
  const Positions& positions_;
  uint32_t run_ = 0;
  std::vector<Mark> marks_;           // of the vertices
  std::vector<uint32_t> face_stamp_;  // reached where it is run_
  std::vector<Entry> heap_;
  std::vector<uint32_t> faces_;
  double farthest_ = 0;
};

template <typename Within>
void Flood::Run(std::span<const uint32_t> edges, double limit,
                const Within& within) {
  Start(edges, limit);
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<Entry>());
    const auto [distance, v] = heap_.back();
    heap_.pop_back();
    if (distance > marks_[v].distance) continue;
    for (uint32_t f : adjacency_.VertexFaces(v)) {
      if (face_stamp_[f] != run_) {
        if (!within(f)) continue;
        faces_.push_back(f);
        face_stamp_[f] = run_;
      }
      for (uint32_t u : mesh_.faces[f])
        if (u != v && !IsNear(u, distance))
          Reach(u, distance + (positions_.row(u) - positions_.row(v)).norm(),
                limit);
    }
  }
  FindFarthest(limit);
}

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_FLOOD_H_
