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
  std::vector<Real> areas;  // by vertex
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
  stencil.areas.resize(mesh.NumVertices(), 0);
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
  const uint64_t max_flips = kMaxFlipsPerEdge * triangulation.NumEdges();
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
      return Rejected(absl::StrCat(
          "more than ", kMaxFlipsPerEdge,
          " flips an edge do not make the triangles Delaunay; remesh the "
          "surface"));
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

// The diagonal is what the rest of its column sums to, rounded once.
void FillDiagonal(Eigen::SparseMatrix<double>& L) {
  for (Eigen::Index j = 0; j < L.cols(); ++j) {
    long double sum = 0;
    double* diagonal = nullptr;
    for (Eigen::SparseMatrix<double>::InnerIterator it(L, j); it; ++it) {
      sum -= it.value();
      if (it.row() == j) diagonal = &it.valueRef();
    }
    *diagonal = static_cast<double>(sum);
  }
}

Eigen::VectorXd Masses(std::vector<Real> areas) {
  auto sum = [&] {
    return std::accumulate(areas.begin(), areas.end(), Real(0));
  };
  const Real least = kLeastMass * sum() / areas.size();
  for (Real& area : areas) area = std::max(area, least);
  const Real total = sum();
  Eigen::VectorXd M(static_cast<Eigen::Index>(areas.size()));
  for (size_t v = 0; v < areas.size(); ++v)
    M[static_cast<Eigen::Index>(v)] = static_cast<double>(areas[v] / total);
  return M;
}

Laplacian Assemble(const Stencil& stencil) {
  const uint32_t n = static_cast<uint32_t>(stencil.areas.size());
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(n + 2 * stencil.edges.size());
  for (const auto& [ends, weight] : stencil.edges) {
    triplets.emplace_back(ends[0], ends[1], -weight);
    triplets.emplace_back(ends[1], ends[0], -weight);
  }
  for (uint32_t v = 0; v < n; ++v) triplets.emplace_back(v, v, 0.0);
  Laplacian result;
  result.report = stencil.report;
  result.L.resize(n, n);
  result.L.setFromTriplets(triplets.begin(), triplets.end());
  FillDiagonal(result.L);
  result.M = Masses(stencil.areas);
  return result;
}

absl::StatusOr<Laplacian> Build(const TriangleMesh& mesh,
                                const CancelToken& cancel) {
  const Adjacency adjacency(mesh);
  std::optional<Stencil> stencil = PlainStencil(mesh, adjacency);
  if (!stencil) {
    MARROW_ASSIGN_OR_RETURN(stencil, FlippedStencil(mesh, adjacency, cancel));
  }
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
    stencil->report.nonmanifold_edges += adjacency.EdgeFaces(e).size() > 2;
  // A bridge conducts as two equilateral triangles across one edge do, about 1.
  for (const auto& ends : FindBridges(mesh))
    stencil->edges.push_back({ends, 1.0});
  Laplacian laplacian = Assemble(*stencil);
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
