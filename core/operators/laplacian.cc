#include "core/operators/laplacian.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/mesh/adjacency.h"
#include "core/operators/bridges.h"
#include "core/operators/intrinsic_triangulation.h"
#include "core/operators/triangle_geometry.h"
#include "core/operators/tufted_cover.h"

namespace marrow {
namespace {

using Real = IntrinsicTriangulation::Real;
using WeightedEdge = IntrinsicTriangulation::Edge;

// What mollification leaves of every triangle inequality, in mean edges. Flat
// triangles grow by the square root of what is added, so they get next to
// nothing, and flips make them go away; what is flat or short after that would
// make L stiff, and bears more.
constexpr double kFlatSlack = 1e-11;
constexpr double kShortSlack = 1e-5;
// Of the mean mass. A vertex among others that all but coincide with it has
// next to none, and what rounds in L would be large against it.
constexpr double kLeastMass = 1e-5;
// A cotangent sum below zero by less than this part of its terms is a right
// angle, rounded.
constexpr double kRounding = 1e-13;

// The edges with their weights, not yet a matrix; areas in any unit.
struct Stencil {
  std::vector<WeightedEdge> edges;
  Eigen::VectorXd areas;  // by vertex
  LaplacianReport report;
};

double Extent(const TriangleMesh& mesh) {
  return (mesh.positions.colwise().maxCoeff() -
          mesh.positions.colwise().minCoeff())
      .maxCoeff();
}

// The distance of two vertices in units of the extent, so that squares of
// coordinates near 1e20 or 1e-20 neither overflow nor vanish.
template <typename T>
T Distance(const TriangleMesh& mesh, uint32_t u, uint32_t v, double extent) {
  T sum = 0;
  for (int i = 0; i < 3; ++i) {
    const T d = (T(mesh.positions(u, i)) - T(mesh.positions(v, i))) / extent;
    sum += d * d;
  }
  return std::sqrt(sum);
}

template <typename T>
std::vector<T> EdgeLengths(const TriangleMesh& mesh,
                           const Adjacency& adjacency) {
  const double extent = Extent(mesh);
  std::vector<T> lengths(adjacency.NumEdges());
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const auto [u, v] = adjacency.EdgeVertices(e);
    lengths[e] = Distance<T>(mesh, u, v, extent);
  }
  return lengths;
}

// The mean over the sides of faces.
template <typename T>
T MeanLength(const Adjacency& adjacency, const std::vector<T>& lengths) {
  T sum = 0;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    sum += adjacency.EdgeFaces(e).size() * lengths[e];
  return sum / (3.0 * adjacency.NumFaces());
}

// What is known of the faces at an edge.
struct EdgeCotangents {
  double sum = 0;
  // The two least, the only one twice.
  std::array<double, 2> least = {};
  uint32_t faces = 0;

  void Add(double cotangent) {
    sum += cotangent;
    if (faces++ == 0) {
      least = {cotangent, cotangent};
    } else if (faces == 2 || cotangent < least[1]) {
      least[1] = cotangent;
    }
    if (least[1] < least[0]) std::swap(least[0], least[1]);
  }
  // Whether the edge is Delaunay in the tufted cover however the sheets at it
  // are paired.
  bool IsDelaunay() const {
    return least[0] + least[1] >=
           -kRounding * (1 + std::abs(least[0]) + std::abs(least[1]));
  }
};

// The stencil of the mesh's own triangles, if they need no help.
std::optional<Stencil> PlainStencil(const TriangleMesh& mesh,
                                    const Adjacency& adjacency) {
  const std::vector<double> lengths = EdgeLengths<double>(mesh, adjacency);
  const double slack = kShortSlack * MeanLength(adjacency, lengths);
  std::vector<EdgeCotangents> cotangents(adjacency.NumEdges());
  Stencil stencil;
  stencil.areas = Eigen::VectorXd::Zero(mesh.NumVertices());
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const auto& edges = adjacency.FaceEdges(f);
    const double a = lengths[edges[0]], b = lengths[edges[1]],
                 c = lengths[edges[2]];
    if (!(TriangleSlack(a, b, c) >= slack)) return std::nullopt;
    const double area = TriangleArea(a, b, c);
    cotangents[edges[0]].Add(ScaledCotangent(a, b, c) / (4 * area));
    cotangents[edges[1]].Add(ScaledCotangent(b, c, a) / (4 * area));
    cotangents[edges[2]].Add(ScaledCotangent(c, a, b) / (4 * area));
    for (uint32_t v : mesh.faces[f]) stencil.areas[v] += area / 3;
  }
  stencil.edges.reserve(cotangents.size());
  for (uint32_t e = 0; e < cotangents.size(); ++e) {
    if (!cotangents[e].IsDelaunay()) return std::nullopt;
    stencil.edges.push_back(
        {adjacency.EdgeVertices(e), std::max(0.0, 0.5 * cotangents[e].sum)});
  }
  return stencil;
}

absl::Status Rejected(const std::string& message) {
  return WithReason(absl::InvalidArgumentError(message), kReasonMeshRejected);
}

// Mollifies and flips until nothing is flat, then once more for what is short.
absl::Status MakeDelaunay(IntrinsicTriangulation& triangulation, Real mean,
                          const CancelToken& cancel, LaplacianReport& report) {
  const uint64_t max_flips = MaxFlips(triangulation.NumEdges());
  for (double slack : {kFlatSlack, kShortSlack}) {
    const Real added = triangulation.Mollify(slack * mean);
    if (slack == kShortSlack && added == 0) break;
    report.mollification += static_cast<double>(added / mean);
    if (!(report.mollification <= kMaxMollification))
      return Rejected(absl::StrCat(
          "the triangles are so degenerate that every edge would have to grow "
          "by ",
          report.mollification, " mean edges; remesh the surface"));
    auto flips = triangulation.FlipToDelaunay(max_flips - report.flips, cancel);
    if (absl::IsResourceExhausted(flips.status()))
      return Rejected(
          absl::StrCat(max_flips,
                       " edge flips do not make the triangles Delaunay; remesh "
                       "the surface"));
    MARROW_RETURN_IF_ERROR(flips.status());
    report.flips += *flips;
  }
  return absl::OkStatus();
}

absl::StatusOr<Stencil> FlippedStencil(const TriangleMesh& mesh,
                                       const Adjacency& adjacency,
                                       const CancelToken& cancel) {
  Stencil stencil;
  const std::vector<Real> lengths = EdgeLengths<Real>(mesh, adjacency);
  const bool is_oriented = IsClosedAndOriented(mesh, adjacency);
  GluedTriangles glued = is_oriented ? GlueFaces(mesh, adjacency)
                                     : GlueTuftedCover(mesh, adjacency);
  stencil.report.path =
      is_oriented ? LaplacianPath::kDelaunay : LaplacianPath::kTufted;
  const uint32_t sheets = glued.sheets;
  IntrinsicTriangulation triangulation(std::move(glued), lengths);
  MARROW_RETURN_IF_ERROR(MakeDelaunay(
      triangulation, MeanLength(adjacency, lengths), cancel, stencil.report));
  stencil.edges = triangulation.WeightedEdges();
  for (WeightedEdge& edge : stencil.edges) edge.weight /= sheets;
  stencil.areas = triangulation.VertexAreas(mesh.NumVertices());
  return stencil;
}

uint64_t SortKey(const WeightedEdge& edge) {
  return uint64_t{edge.ends[0]} << 32 | edge.ends[1];
}

// Leaves one entry for each pair of vertices, the lesser first, in ascending
// order.
void Merge(std::vector<WeightedEdge>& edges) {
  bool is_merged = true;
  uint64_t last = 0;
  for (WeightedEdge& edge : edges) {
    if (edge.ends[0] > edge.ends[1]) std::swap(edge.ends[0], edge.ends[1]);
    is_merged &= last < SortKey(edge);
    last = SortKey(edge);
  }
  if (is_merged) return;
  std::stable_sort(edges.begin(), edges.end(),
                   [](const WeightedEdge& a, const WeightedEdge& b) {
                     return SortKey(a) < SortKey(b);
                   });
  size_t kept = 0;
  for (size_t e = 1; e < edges.size(); ++e) {
    if (SortKey(edges[kept]) == SortKey(edges[e])) {
      edges[kept].weight += edges[e].weight;
    } else {
      edges[++kept] = edges[e];
    }
  }
  edges.resize(kept + 1);
}

// In the order of merged edges the entries of a column come from the top down,
// with those above the diagonal before any below it.
Eigen::SparseMatrix<double> Matrix(const std::vector<WeightedEdge>& edges,
                                   uint32_t n) {
  std::vector<Real> sums(n, 0);
  std::vector<int> counts(n, 1), above(n, 0);
  for (const auto& [ends, weight] : edges) {
    for (uint32_t v : ends) {
      sums[v] += weight;
      ++counts[v];
    }
    ++above[ends[1]];
  }
  Eigen::SparseMatrix<double> L(n, n);
  L.resizeNonZeros(n + 2 * static_cast<Eigen::Index>(edges.size()));
  int* starts = L.outerIndexPtr();
  std::partial_sum(counts.begin(), counts.end(), starts + 1);
  std::vector<int> next(starts, starts + n);
  auto put = [&](uint32_t column, uint32_t row, double value) {
    L.innerIndexPtr()[next[column]] = static_cast<int>(row);
    L.valuePtr()[next[column]++] = value;
  };
  auto put_diagonal = [&](uint32_t v) {
    if (above[v]-- == 0) put(v, v, static_cast<double>(sums[v]));
  };
  for (uint32_t v = 0; v < n; ++v) put_diagonal(v);
  for (const auto& [ends, weight] : edges) {
    put(ends[0], ends[1], -weight);
    put(ends[1], ends[0], -weight);
    put_diagonal(ends[1]);
  }
  return L;
}

Eigen::VectorXd Masses(const Eigen::VectorXd& areas) {
  const Eigen::VectorXd lifted = areas.cwiseMax(kLeastMass * areas.mean());
  const Real sum = std::accumulate(lifted.begin(), lifted.end(), Real(0));
  return lifted / static_cast<double>(sum);
}

absl::StatusOr<Laplacian> Build(const TriangleMesh& mesh,
                                const CancelToken& cancel) {
  const Adjacency adjacency(mesh, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  std::optional<Stencil> stencil = PlainStencil(mesh, adjacency);
  if (!stencil) {
    MARROW_ASSIGN_OR_RETURN(stencil, FlippedStencil(mesh, adjacency, cancel));
  }
  MARROW_RETURN_IF_ERROR(cancel.Check());
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    stencil->report.nonmanifold_edges += adjacency.EdgeFaces(e).size() > 2;
  for (const Bridge& ends : FindBridges(mesh, cancel))
    stencil->edges.push_back({ends, kBridgeWeight});
  MARROW_RETURN_IF_ERROR(cancel.Check());
  Merge(stencil->edges);
  Laplacian laplacian{Matrix(stencil->edges, mesh.NumVertices()),
                      Masses(stencil->areas), stencil->report};
  MARROW_RETURN_IF_ERROR(cancel.Check());
  MARROW_RETURN_IF_ERROR(CheckLaplacian(laplacian));
  return laplacian;
}

}  // namespace

absl::StatusOr<Laplacian> BuildLaplacian(const TriangleMesh& mesh,
                                         const CancelToken& cancel) {
  try {
    return Build(mesh, cancel);
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError(
        absl::StrCat("not enough memory for the Laplacian of ",
                     mesh.NumVertices(), " vertices"));
  }
}

std::vector<double> FaceAreaShares(const TriangleMesh& mesh) {
  const double extent = Extent(mesh);
  std::vector<double> areas(mesh.NumFaces());
  double sum = 0;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const auto [u, v, w] = mesh.faces[f];
    areas[f] = TriangleArea(Distance<double>(mesh, u, v, extent),
                            Distance<double>(mesh, v, w, extent),
                            Distance<double>(mesh, w, u, extent));
    sum += areas[f];
  }
  for (double& area : areas) area /= sum;
  return areas;
}

}  // namespace marrow
