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

void Flood::Start(std::span<const uint32_t> edges, double limit) {
  ++run_;
  faces_.clear();
  heap_.clear();
  for (uint32_t e : edges)
    for (uint32_t v : adjacency_.EdgeVertices(e)) Reach(v, 0, limit);
}

void Flood::FindFarthest(double limit) {
  farthest_ = 0;
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

}  // namespace marrow
