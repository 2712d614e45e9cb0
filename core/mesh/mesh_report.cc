#include "core/mesh/mesh_report.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/cancellable.h"
#include "core/base/disjoint_sets.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/components.h"
#include "core/mesh/orientation.h"
#include "core/mesh/rims.h"
#include "core/mesh/unit_box.h"

namespace marrow {
namespace {

using Eigen::Vector3d;

// A sum of doubles without rounding: components that do not overlap, so that
// it is zero only where each of them is.
class ExactSum {
 public:
  void Add(double x) {
    for (size_t i = 0; i < size_; ++i) {
      const double sum = x + parts_[i];
      const double part = sum - x;
      parts_[i] = (x - (sum - part)) + (parts_[i] - part);
      x = sum;
    }
    parts_[size_++] = x;
  }
  void AddProduct(double a, double b) {
    const double product = a * b;
    Add(std::fma(a, b, -product));
    Add(product);
  }
  bool IsZero() const {
    return std::all_of(parts_, parts_ + size_, [](double p) { return p == 0; });
  }

 private:
  double parts_[12] = {};
  size_t size_ = 0;
};

// Whether a, b and c, seen along one axis, lie on a line.
bool CollinearInPlane(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                      int x, int y) {
  ExactSum twice_area;
  for (const auto& [p, q] : {std::pair{&a, &b}, {&b, &c}, {&c, &a}}) {
    twice_area.AddProduct((*p)[x], (*q)[y]);
    twice_area.AddProduct(-(*q)[x], (*p)[y]);
  }
  return twice_area.IsZero();
}

bool Collinear(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return CollinearInPlane(a, b, c, 0, 1) && CollinearInPlane(a, b, c, 1, 2) &&
         CollinearInPlane(a, b, c, 2, 0);
}

// An angle under one degree. The least is opposite to the shortest edge.
bool IsSliver(const Vector3d& a, const Vector3d& b, const Vector3d& c,
              double cross) {
  constexpr double kSineOfOneDegree = 0.017452406437283512;
  double edges[] = {(b - a).stableNorm(), (c - b).stableNorm(),
                    (a - c).stableNorm()};
  std::sort(edges, edges + 3);
  return cross < kSineOfOneDegree * edges[1] * edges[2];
}

absl::Status MeasureArea(const TriangleMesh& mesh, const CancelToken& cancel,
                         MeshReport& report) {
  // Below this share of the longest coordinates the rounding of the cross
  // product could hide that the corners are not quite on a line.
  constexpr double kDoubt = 1e-14;
  const double scale = UnitScale(mesh);
  double twice_area = 0;
  const auto measure = [&](size_t f) {
    const Triangle& face = mesh.faces[f];
    const Vector3d a = mesh.Position(face[0]) * scale;
    const Vector3d b = mesh.Position(face[1]) * scale;
    const Vector3d c = mesh.Position(face[2]) * scale;
    const double cross = (b - a).cross(c - a).stableNorm();
    const double reach =
        std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
    if (IsSliver(a, b, c, cross)) ++report.sliver_faces;
    if (cross <= kDoubt * reach && Collinear(a, b, c)) {
      ++report.zero_area_faces;
    } else {
      twice_area += cross;
    }
  };
  MARROW_RETURN_IF_ERROR(ForEachIndex(mesh.faces.size(), cancel, measure));
  report.area = twice_area / 2 / scale / scale;
  return absl::OkStatus();
}

void CountEdges(const Adjacency& adjacency, MeshReport& report) {
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    if (adjacency.EdgeFaces(e).size() >= 3) ++report.nonmanifold_edges;
    if (adjacency.IsBoundaryEdge(e)) ++report.boundary_edges;
  }
  const std::vector<uint32_t> rim_of_vertex = RimOfVertices(adjacency);
  for (uint32_t v : RimVertices(adjacency))
    if (rim_of_vertex[v] == v) ++report.boundary_loops;
}

uint32_t CornerOf(const TriangleMesh& mesh, uint32_t f, uint32_t v) {
  const Triangle& face = mesh.faces[f];
  return 3 * f + (face[0] == v ? 0 : face[1] == v ? 1 : 2);
}

// Joins the corners of a vertex across each edge that has it; every group that
// is left is a fan.
absl::Status CountSplitVertices(const TriangleMesh& mesh,
                                const Adjacency& adjacency,
                                const CancelToken& cancel, MeshReport& report) {
  DisjointSets fans(3 * mesh.faces.size());
  const auto join = [&](uint32_t e) {
    const auto faces = adjacency.EdgeFaces(e);
    for (uint32_t v : adjacency.EdgeVertices(e)) {
      for (uint32_t f : faces) {
        fans.Union(CornerOf(mesh, faces[0], v), CornerOf(mesh, f, v));
      }
    }
  };
  MARROW_RETURN_IF_ERROR(ForEachIndex(adjacency.NumEdges(), cancel, join));
  std::vector<uint32_t> fans_of_vertex(mesh.NumVertices(), 0);
  return ForEachIndex(3 * mesh.faces.size(), cancel, [&](uint32_t corner) {
    if (fans.Find(corner) != corner) return;
    if (++fans_of_vertex[mesh.faces[corner / 3][corner % 3]] == 2) {
      ++report.nonmanifold_vertices;
    }
  });
}

absl::Status FillReport(const TriangleMesh& mesh, const CancelToken& cancel,
                        MeshReport& report) {
  report.vertices = mesh.NumVertices();
  report.faces = mesh.NumFaces();
  report.box_min = mesh.positions.colwise().minCoeff().transpose();
  report.box_max = mesh.positions.colwise().maxCoeff().transpose();
  const Adjacency adjacency(mesh, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  MARROW_RETURN_IF_ERROR(MeasureArea(mesh, cancel, report));
  CountEdges(adjacency, report);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  DisjointSets vertices(mesh.NumVertices());
  report.components = JoinCorners(mesh, vertices);
  MARROW_RETURN_IF_ERROR(CountSplitVertices(mesh, adjacency, cancel, report));
  report.euler_characteristic = static_cast<int64_t>(report.vertices) -
                                adjacency.NumEdges() +
                                static_cast<int64_t>(report.faces);
  const Orientation orientation = CheckOrientation(mesh, adjacency, cancel);
  report.flipped_faces = orientation.flipped_faces;
  report.orientable = orientation.orientable;
  if (report.orientable && report.boundary_edges == 0 &&
      report.nonmanifold_edges == 0 && report.nonmanifold_vertices == 0) {
    report.genus = report.components - report.euler_characteristic / 2;
  }
  return absl::OkStatus();
}

}  // namespace

MeshReport ReportOn(const TriangleMesh& mesh, const CancelToken& cancel) {
  MeshReport report;
  (void)FillReport(mesh, cancel, report);
  return report;
}

}  // namespace marrow
