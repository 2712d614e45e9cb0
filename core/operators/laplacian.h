// The Laplace-Beltrami operator of a triangle mesh, scaled to area 1, whatever
// the triangles.
#ifndef MARROW_CORE_OPERATORS_LAPLACIAN_H_
#define MARROW_CORE_OPERATORS_LAPLACIAN_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// How the mesh's own triangles became those of the operator.
enum class LaplacianPath {
  // As they are: nothing to mollify, and opposite angles sum to at most 180
  // degrees at every edge.
  kPlain,
  // By flips on the mesh itself, which is closed and oriented.
  kDelaunay,
  // By flips on the tufted cover, which any mesh has.
  kTufted,
};

struct LaplacianReport {
  LaplacianPath path = LaplacianPath::kPlain;
  // What was added to every edge so that no triangle is degenerate, in units
  // of the mean edge length; at most kMaxMollification.
  double mollification = 0;
  uint64_t flips = 0;  // at most MaxFlips() of the edges that could be flipped
  uint64_t nonmanifold_edges = 0;  // of three faces or more

  // That of several meshes: sums, and the most of what is no count.
  void Add(const LaplacianReport& other) {
    path = std::max(path, other.path);
    mollification = std::max(mollification, other.mollification);
    flips += other.flips;
    nonmanifold_edges += other.nonmanifold_edges;
  }
};

// L: n x n, symmetric to the last bit, off-diagonal entries at most 0 and rows
//    that sum to 0; hence positive semi-definite. Constants alone are in its
//    kernel (separate components are joined by bridges.h).
//    L_ij = -(cot a_ij + cot b_ij) / 2 (Pinkall and Polthier 1993), summed over
//    the edges from i to j of an intrinsic Delaunay triangulation.
// M: the diagonal of the lumped mass matrix, a third of the area around each
//    vertex, but at least 1e-5 of the mean; sums to 1.
struct Laplacian {
  Eigen::SparseMatrix<double> L;
  Eigen::VectorXd M;
  LaplacianReport report;
};

inline constexpr double kMaxMollification = 1e-3;

// Bad meshes take up to 5 flips an edge, long twisted fans a number that grows
// with the square: 50 an edge are allowed, and of those beyond 10 an edge, as
// many as take some seconds.
constexpr uint64_t MaxFlips(uint64_t edges) {
  return edges * 10 + std::min<uint64_t>(edges * 40, 10'000'000);
}

// Sharp and Crane 2020, "A Laplacian for Nonmanifold Triangle Meshes": works on
// edge lengths alone, so degenerate triangles and coordinates of any size are
// no trouble; any number of faces may meet at an edge, in any orientation. On
// meshes whose triangles are good this is the cotangent Laplacian.
//
// REQUIRES: every vertex is used by a face; finite positions that are not all
// equal. O(n log n) but for flips; deterministic; thread safe. Errors:
// CANCELLED; INVALID_ARGUMENT with reason MESH_REJECTED where one of the bounds
// of the report would be passed; RESOURCE_EXHAUSTED for want of memory; those
// of CheckLaplacian().
absl::StatusOr<Laplacian> BuildLaplacian(
    const TriangleMesh& mesh, const CancelToken& cancel = CancelToken());

// Whether the operator is what the comment on Laplacian promises: finite,
// symmetric to the last bit, off-diagonal entries at most 1e-14 and row sums at
// most 1e-12 of the largest diagonal entry, masses positive and summing to 1.
// Linear in the entries. Errors: INTERNAL, whose message names the row.
absl::Status CheckLaplacian(const Laplacian& laplacian);

// Area of each face as a share of the mesh's area. Sums to 1.
std::vector<double> FaceAreaShares(const TriangleMesh& mesh);

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_LAPLACIAN_H_
