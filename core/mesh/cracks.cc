#include "core/mesh/cracks.h"

#include <algorithm>
#include <utility>

#include "core/base/cancellable.h"
#include "core/base/disjoint_sets.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/rims.h"
#include "core/mesh/unit_box.h"
#include "core/mesh/vertex_cloud.h"

namespace marrow {
namespace {

constexpr double kMostBreadth = 1e-5;
constexpr double kMostOfEdge = 0.1;

// How far from each vertex others are one with it, squared.
std::vector<double> SquaredReach(const TriangleMesh& mesh,
                                 const Positions& points) {
  std::vector<double> reach(mesh.NumVertices(), kMostBreadth * kMostBreadth);
  for (const Triangle& face : mesh.faces)
    for (int i = 0; i < 3; ++i) {
      const uint32_t u = face[i], v = face[(i + 1) % 3];
      const double limit = kMostOfEdge * kMostOfEdge *
                           (points.row(u) - points.row(v)).squaredNorm();
      reach[u] = std::min(reach[u], limit);
      reach[v] = std::min(reach[v], limit);
    }
  return reach;
}

}  // namespace

absl::StatusOr<std::vector<uint32_t>> FindCracks(const TriangleMesh& mesh,
                                                 const CancelToken& cancel) {
  const Adjacency adjacency(mesh, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const std::vector<uint32_t> rim = RimVertices(adjacency);
  DisjointSets sets(mesh.NumVertices());
  if (rim.empty()) return sets.Representatives();
  const Positions points = ToUnitBox(mesh).points;
  const std::vector<double> reach = SquaredReach(mesh, points);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const VertexCloud cloud{points, rim};
  const VertexTree tree(3, cloud);
  std::vector<std::pair<uint32_t, double>> near;
  MARROW_RETURN_IF_ERROR(ForEachIndex(rim.size(), cancel, [&](size_t k) {
    const uint32_t v = rim[k];
    const Eigen::Vector3d place = points.row(v).transpose();
    tree.radiusSearch(place.data(), reach[v], near,
                      nanoflann::SearchParams(32, 0, false));
    for (const auto& [i, square] : near)
      if (square < reach[rim[i]]) sets.Union(v, rim[i]);
  }));
  return sets.Representatives();
}

}  // namespace marrow
