#include "core/boundaries/flood.h"

#include <algorithm>
#include <limits>

namespace marrow {

Flood::Flood(const TriangleMesh& mesh, const Adjacency& adjacency,
             const Positions& positions)
    : mesh_(mesh),
      adjacency_(adjacency),
      positions_(positions),
      marks_(mesh.NumVertices()),
      face_stamp_(mesh.NumFaces(), 0) {}

void Flood::Run(std::span<const uint32_t> edges, double limit,
                const std::function<bool(uint32_t)>& within) {
  ++run_;
  faces_.clear();
  heap_.clear();
  farthest_ = 0;
  for (uint32_t e : edges)
    for (uint32_t v : adjacency_.EdgeVertices(e)) Reach(v, 0, limit);
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<Entry>());
    const auto [distance, v] = heap_.back();
    heap_.pop_back();
    if (distance > marks_[v].distance) continue;
    for (uint32_t f : adjacency_.VertexFaces(v)) {
      if (!within(f)) continue;
      if (face_stamp_[f] != run_) faces_.push_back(f);
      face_stamp_[f] = run_;
      for (uint32_t u : mesh_.faces[f])
        if (u != v && !IsNear(u, distance))
          Reach(u, distance + (positions_.row(u) - positions_.row(v)).norm(),
                limit);
    }
  }
  for (uint32_t f : faces_)
    for (uint32_t v : mesh_.faces[f])
      farthest_ = std::max(farthest_, std::min(limit, marks_[v].distance));
}

double Flood::DistanceOf(uint32_t face) const {
  double sum = 0;
  for (uint32_t v : mesh_.faces[face]) sum += marks_[v].distance;
  return sum / 3;
}

double Flood::ShareWithin(uint32_t face, double distance) const {
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (uint32_t v : mesh_.faces[face]) {
    nearest = std::min(nearest, marks_[v].distance);
    farthest = std::max(farthest, marks_[v].distance);
  }
  if (!(nearest < farthest)) return nearest < distance;
  const double from_middle =
      (distance - DistanceOf(face)) / (farthest - nearest);
  return std::clamp(0.5 + from_middle, 0.0, 1.0);
}

void Flood::Reach(uint32_t vertex, double distance, double limit) {
  if (IsNear(vertex, distance)) return;
  marks_[vertex] = {run_, distance};
  if (distance >= limit) return;
  heap_.push_back({distance, vertex});
  std::push_heap(heap_.begin(), heap_.end(), std::greater<Entry>());
}

}  // namespace marrow
