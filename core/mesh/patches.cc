#include "core/mesh/patches.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/base/cancellable.h"
#include "core/base/disjoint_sets.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/components.h"
#include "core/mesh/unit_box.h"

namespace marrow {
namespace {

// Of a component, what an outline would be filled with is about half or more;
// a hole of several faces among few is less.
constexpr double kMostOfComponent = 0.25;

// An end of a rim edge.
struct RimEnd {
  uint32_t vertex;
  uint32_t fan;  // of the faces that edges of two faces join around the vertex
  uint32_t edge;
  double angle = 0;  // around the vertex
};

Eigen::Vector3d AreaVector(const Positions& points, const Triangle& face) {
  const Eigen::Vector3d u =
      (points.row(face[1]) - points.row(face[0])).transpose();
  const Eigen::Vector3d v =
      (points.row(face[2]) - points.row(face[0])).transpose();
  return 0.5 * u.cross(v);
}

// Which rim edge follows which at a vertex, across a gap.
class Gaps {
 public:
  Gaps(const TriangleMesh& mesh, const Positions& points,
       const Adjacency& adjacency)
      : mesh_(mesh),
        points_(points),
        adjacency_(adjacency),
        across_(adjacency.NumEdges(), {kNoIndex, kNoIndex}) {}

  absl::Status Find(const CancelToken& cancel) {
    MARROW_ASSIGN_OR_RETURN(std::vector<RimEnd> ends, Ends(cancel));
    MARROW_RETURN_IF_ERROR(SortUnlessCancelled(
        ends.begin(), ends.end(),
        [](const RimEnd& a, const RimEnd& b) {
          return a.vertex != b.vertex ? a.vertex < b.vertex : a.edge < b.edge;
        },
        cancel));
    return ForEachIndex(ends.size(), cancel, [&](size_t i) {
      if (i > 0 && ends[i - 1].vertex == ends[i].vertex) return;
      size_t end = i;
      while (end < ends.size() && ends[end].vertex == ends[i].vertex) ++end;
      Join({ends.begin() + i, ends.begin() + end});
    });
  }

  // kNoIndex where it is not clear.
  uint32_t Across(uint32_t edge, uint32_t vertex) const {
    return across_[edge][adjacency_.EdgeVertices(edge)[1] == vertex];
  }

 private:
  absl::StatusOr<std::vector<RimEnd>> Ends(const CancelToken& cancel) const {
    DisjointSets corners(3 * mesh_.NumFaces());
    const auto corner = [&](uint32_t f, uint32_t v) {
      const Triangle& face = mesh_.faces[f];
      return 3 * f + (face[1] == v) + 2 * (face[2] == v);
    };
    const uint32_t n = adjacency_.NumEdges();
    MARROW_RETURN_IF_ERROR(ForEachIndex(n, cancel, [&](uint32_t e) {
      const auto faces = adjacency_.EdgeFaces(e);
      if (faces.size() != 2) return;
      for (uint32_t v : adjacency_.EdgeVertices(e))
        corners.Union(corner(faces[0], v), corner(faces[1], v));
    }));
    std::vector<RimEnd> ends;
    MARROW_RETURN_IF_ERROR(ForEachIndex(n, cancel, [&](uint32_t e) {
      if (!adjacency_.IsBoundaryEdge(e)) return;
      for (uint32_t v : adjacency_.EdgeVertices(e))
        ends.push_back(
            {v, corners.Find(corner(adjacency_.EdgeFaces(e)[0], v)), e});
    }));
    return ends;
  }

  // The ends at one vertex.
  void Join(std::vector<RimEnd> ends) {
    const size_t n = ends.size();
    if (n % 2 != 0) return;
    if (n > 2) SortAround(ends);
    const size_t first = ends[0].fan == ends[1].fan ? 0 : 1;
    for (size_t i = first; i < n + first; i += 2)
      if (ends[i % n].fan != ends[(i + 1) % n].fan) return;
    for (size_t i = first; i < n + first; i += 2) {
      const RimEnd& a = ends[(i + 1) % n];
      const RimEnd& b = ends[(i + 2) % n];
      Set(a, b.edge);
      Set(b, a.edge);
    }
  }

  void Set(const RimEnd& end, uint32_t across) {
    across_[end.edge][adjacency_.EdgeVertices(end.edge)[1] == end.vertex] =
        across;
  }

  // Seen along the direction from which the faces look largest.
  void SortAround(std::vector<RimEnd>& ends) const {
    const uint32_t v = ends[0].vertex;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (uint32_t f : adjacency_.VertexFaces(v)) {
      const Eigen::Vector3d area = AreaVector(points_, mesh_.faces[f]);
      const double norm = area.norm();
      if (norm > 0) spread += area * area.transpose() / norm;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    for (RimEnd& end : ends) {
      const auto [a, b] = adjacency_.EdgeVertices(end.edge);
      const Eigen::RowVector3d along =
          points_.row(a == v ? b : a) - points_.row(v);
      end.angle = std::atan2(along.dot(axes.eigenvectors().col(1)),
                             along.dot(axes.eigenvectors().col(0)));
    }
    std::sort(ends.begin(), ends.end(), [](const RimEnd& a, const RimEnd& b) {
      return a.angle != b.angle ? a.angle < b.angle : a.edge < b.edge;
    });
  }

  const TriangleMesh& mesh_;
  const Positions& points_;
  const Adjacency& adjacency_;
  std::vector<std::array<uint32_t, 2>> across_;  // by edge and end
};

// Vertices around a hole.
using Rim = std::vector<uint32_t>;

// The way to fill a rim that has the least area, by the areas of the least ways
// to fill its parts.
class Filler {
 public:
  Filler(const Positions& points, const Adjacency& adjacency)
      : points_(points), edges_(adjacency) {}

  // Of faces along the rim's direction. Infinite where there is no way.
  double Fill(const Rim& rim, std::vector<Triangle>& faces) {
    const size_t n = rim.size();
    least_.assign(n * n, 0);
    middle_.assign(n * n, 0);
    for (size_t span = 2; span < n; ++span)
      for (size_t i = 0; i + span < n; ++i) Solve(rim, i, i + span);
    if (std::isfinite(least_[n - 1])) Take(rim, 0, n - 1, faces);
    return least_[n - 1];
  }

 private:
  void Solve(const Rim& rim, size_t i, size_t k) {
    const size_t n = rim.size();
    double& best = least_[i * n + k];
    best = std::numeric_limits<double>::infinity();
    if (k - i < n - 1 && HasEdge(rim[i], rim[k])) return;
    for (size_t j = i + 1; j < k; ++j) {
      const double area = least_[i * n + j] + least_[j * n + k] +
                          AreaVector(points_, {rim[i], rim[j], rim[k]}).norm();
      if (!(area < best)) continue;
      best = area;
      middle_[i * n + k] = j;
    }
  }

  void Take(const Rim& rim, size_t i, size_t k, std::vector<Triangle>& faces) {
    if (k - i < 2) return;
    const size_t j = middle_[i * rim.size() + k];
    faces.push_back({rim[i], rim[j], rim[k]});
    Take(rim, i, j, faces);
    Take(rim, j, k, faces);
  }

  bool HasEdge(uint32_t u, uint32_t v) const {
    const std::array<uint32_t, 2> ends{std::min(u, v), std::max(u, v)};
    uint32_t low = 0, high = edges_.NumEdges();
    while (low < high) {
      const uint32_t middle = low + (high - low) / 2;
      if (edges_.EdgeVertices(middle) < ends)
        low = middle + 1;
      else
        high = middle;
    }
    return low < edges_.NumEdges() && edges_.EdgeVertices(low) == ends;
  }

  const Positions& points_;
  const Adjacency& edges_;
  std::vector<double> least_;   // of the rim from i to k, at i * n + k
  std::vector<size_t> middle_;  // third corner of the face at that side
};

class Patcher {
 public:
  explicit Patcher(const TriangleMesh& mesh, const CancelToken& cancel)
      : mesh_(mesh),
        adjacency_(mesh, cancel),
        points_(ToUnitBox(mesh).points) {}

  absl::StatusOr<std::vector<Triangle>> Patch(const CancelToken& cancel) {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    Gaps gaps(mesh_, points_, adjacency_);
    MARROW_RETURN_IF_ERROR(gaps.Find(cancel));
    MeasureComponents();
    Filler filler(points_, adjacency_);
    std::vector<Triangle> patches;
    std::vector<bool> done(adjacency_.NumEdges(), false);
    MARROW_RETURN_IF_ERROR(
        ForEachIndex(adjacency_.NumEdges(), cancel, [&](uint32_t e) {
          if (!adjacency_.IsBoundaryEdge(e) || done[e]) return;
          std::vector<uint32_t> edges;
          const Rim rim = RimFrom(gaps, e, edges, done);
          if (rim.size() < 3) return;
          std::vector<Triangle> faces;
          const double area = filler.Fill(rim, faces);
          if (area > kMostOfComponent * AreaAround(edges)) return;
          for (const Triangle& face : faces) patches.push_back(Canonical(face));
        }));
    MARROW_RETURN_IF_ERROR(SortUnlessCancelled(patches.begin(), patches.end(),
                                               std::less<>(), cancel));
    return patches;
  }

 private:
  double LengthOf(uint32_t e) const {
    const auto [a, b] = adjacency_.EdgeVertices(e);
    return (points_.row(a) - points_.row(b)).norm();
  }

  void MeasureComponents() {
    DisjointSets sets(mesh_.NumVertices());
    JoinCorners(mesh_, sets);
    component_ = sets.Representatives();
    component_area_.assign(mesh_.NumVertices(), 0);
    DisjointSets pieces(mesh_.NumFaces());
    for (uint32_t e = 0; e < adjacency_.NumEdges(); ++e)
      for (uint32_t f : adjacency_.EdgeFaces(e))
        pieces.Union(adjacency_.EdgeFaces(e)[0], f);
    piece_ = pieces.Representatives();
    piece_area_.assign(mesh_.NumFaces(), 0);
    double area = 0;
    for (uint32_t f = 0; f < mesh_.NumFaces(); ++f) {
      const Triangle& face = mesh_.faces[f];
      const double here = AreaVector(points_, face).norm();
      component_area_[component_[face[0]]] += here;
      piece_area_[piece_[f]] += here;
      area += here;
    }
    double rims = 0, count = 0;
    for (uint32_t e = 0; e < adjacency_.NumEdges(); ++e)
      if (adjacency_.IsBoundaryEdge(e)) {
        rims += LengthOf(e);
        ++count;
      }
    longest_ = std::max(kLongestHole * std::sqrt(area),
                        count > 0 ? kLongestInEdges * rims / count : 0);
  }

  // What a rim may be the outline of: the one piece whose edges it takes, such
  // as a card that hangs on a creature by a vertex, or the component.
  double AreaAround(const std::vector<uint32_t>& edges) const {
    const uint32_t first = adjacency_.EdgeFaces(edges[0])[0];
    const bool is_one = std::ranges::all_of(edges, [&](uint32_t e) {
      return piece_[adjacency_.EdgeFaces(e)[0]] == piece_[first];
    });
    return is_one ? piece_area_[piece_[first]]
                  : component_area_[component_[mesh_.faces[first][0]]];
  }

  // Against the direction of the face at its first edge; empty where it is no
  // small hole.
  Rim RimFrom(const Gaps& gaps, uint32_t first, std::vector<uint32_t>& edges,
              std::vector<bool>& done) const {
    Rim rim;
    double length = 0;
    uint32_t e = first, v = adjacency_.EdgeVertices(e)[0];
    do {
      rim.push_back(v);
      edges.push_back(e);
      const auto [a, b] = adjacency_.EdgeVertices(e);
      length += LengthOf(e);
      v = a == v ? b : a;
      e = gaps.Across(e, v);
      if (e == kNoIndex || rim.size() > kMostHoleEdges || length > longest_)
        return {};
    } while (e != first);
    for (uint32_t edge : edges) done[edge] = true;
    std::vector<uint32_t> sorted = rim;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
      return {};
    if (RunsAlong(first)) std::reverse(rim.begin(), rim.end());
    return rim;
  }

  // Whether its face has the edge from the lesser vertex to the greater.
  bool RunsAlong(uint32_t edge) const {
    const Triangle& face = mesh_.faces[adjacency_.EdgeFaces(edge)[0]];
    const auto [a, b] = adjacency_.EdgeVertices(edge);
    for (int i = 0; i < 3; ++i)
      if (face[i] == a) return face[(i + 1) % 3] == b;
    return false;
  }

  static Triangle Canonical(Triangle face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()),
                face.end());
    return face;
  }

  const TriangleMesh& mesh_;
  const Adjacency adjacency_;
  const Positions points_;
  std::vector<uint32_t> component_;     // of vertex
  std::vector<double> component_area_;  // by its least vertex
  std::vector<uint32_t> piece_;         // of face, by edges
  std::vector<double> piece_area_;      // by its least face
  double longest_ = 0;
};

}  // namespace

absl::StatusOr<std::vector<Triangle>> PatchHoles(const TriangleMesh& mesh,
                                                 const CancelToken& cancel) {
  return Patcher(mesh, cancel).Patch(cancel);
}

}  // namespace marrow
