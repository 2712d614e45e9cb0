#include "core/mesh/cracks.h"

#include <algorithm>
#include <limits>
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
constexpr double kMostOfEdgeInSoup = 0.05;
// Of the sides of a soup's faces. The pages of a book, which are near to each
// other as well, have half of theirs on rims.
constexpr double kLeastOnRims = 0.75;
// Of the vertices on rims.
constexpr double kLeastNear = 0.9;

bool AreMostlyRims(const Adjacency& adjacency) {
  size_t rims = 0;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    rims += adjacency.IsBoundaryEdge(e);
  return rims >= kLeastOnRims * 3 * adjacency.NumFaces();
}

// How far from each vertex others are one with it, squared.
std::vector<double> SquaredReach(const TriangleMesh& mesh,
                                 const Positions& points, double most_breadth,
                                 double most_of_edge) {
  std::vector<double> reach(mesh.NumVertices(), most_breadth * most_breadth);
  for (const Triangle& face : mesh.faces)
    for (int i = 0; i < 3; ++i) {
      const uint32_t u = face[i], v = face[(i + 1) % 3];
      const double limit = most_of_edge * most_of_edge *
                           (points.row(u) - points.row(v)).squaredNorm();
      reach[u] = std::min(reach[u], limit);
      reach[v] = std::min(reach[v], limit);
    }
  return reach;
}

// More are near to no corner of a surface. A hub of very many is closed as far
// as each finds so many, or it would cost the square of them.
constexpr size_t kMostNear = 256;

// nanoflann's view of where those go that are within a radius, squared.
struct FirstNear {
  double radius;
  std::vector<std::pair<uint32_t, double>> found = {};

  bool addPoint(double square, uint32_t i) {
    if (square < radius) found.push_back({i, square});
    return found.size() < kMostNear;
  }
  double worstDist() const { return radius; }
  bool full() const { return true; }
  size_t size() const { return found.size(); }
};

// Calls visit(v, others), the others being those of `rim` that v reaches and
// that reach it, for each of `rim` until it answers false.
template <typename Visit>
absl::Status ForEachNear(const Positions& points,
                         const std::vector<uint32_t>& rim,
                         const std::vector<double>& reach,
                         const CancelToken& cancel, const Visit& visit) {
  const VertexCloud cloud{points, rim};
  const VertexTree tree(3, cloud);
  FirstNear near;
  std::vector<uint32_t> others;
  bool goes_on = true;
  return ForEachIndex(rim.size(), cancel, [&](size_t k) {
    if (!goes_on) return;
    const uint32_t v = rim[k];
    const Eigen::Vector3d place = points.row(v).transpose();
    near.radius = reach[v];
    near.found.clear();
    tree.findNeighbors(near, place.data(), nanoflann::SearchParams());
    others.clear();
    for (const auto& [i, square] : near.found)
      if (square < reach[rim[i]] && rim[i] != v) others.push_back(rim[i]);
    goes_on = visit(v, others);
  });
}

absl::StatusOr<bool> IsSoup(const Adjacency& adjacency, const Positions& points,
                            const std::vector<uint32_t>& rim,
                            const std::vector<double>& reach,
                            const CancelToken& cancel) {
  if (!AreMostlyRims(adjacency)) return false;
  const double most_far = (1 - kLeastNear) * static_cast<double>(rim.size());
  size_t far = 0;
  MARROW_RETURN_IF_ERROR(
      ForEachNear(points, rim, reach, cancel,
                  [&](uint32_t, const std::vector<uint32_t>& others) {
                    far += others.empty();
                    return far <= most_far;
                  }));
  return far <= most_far;
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
  std::vector<double> reach = SquaredReach(
      mesh, points, std::numeric_limits<double>::infinity(), kMostOfEdgeInSoup);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  MARROW_ASSIGN_OR_RETURN(const bool is_soup,
                          IsSoup(adjacency, points, rim, reach, cancel));
  if (!is_soup) reach = SquaredReach(mesh, points, kMostBreadth, kMostOfEdge);
  MARROW_RETURN_IF_ERROR(
      ForEachNear(points, rim, reach, cancel,
                  [&](uint32_t v, const std::vector<uint32_t>& others) {
                    for (uint32_t u : others) sets.Union(u, v);
                    return true;
                  }));
  return sets.Representatives();
}

}  // namespace marrow
