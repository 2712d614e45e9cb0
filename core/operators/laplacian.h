// The Laplace-Beltrami operator of a triangle mesh, scaled to area 1.
#ifndef MARROW_CORE_OPERATORS_LAPLACIAN_H_
#define MARROW_CORE_OPERATORS_LAPLACIAN_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

// L: n x n, symmetric, positive semi-definite, constants in its kernel, and
// nothing else in it (separate components are joined by bridges.h).
//    L_ij = -(cot a_ij + cot b_ij) / 2 (Pinkall and Polthier 1993)
// M: the diagonal of the lumped mass matrix, a third of the area around each
//    vertex; positive; sums to 1.
struct Laplacian {
  Eigen::SparseMatrix<double> L;
  Eigen::VectorXd M;
  // What was added to every edge so that no triangle is degenerate, in units
  // of the mean edge length; 0 for a clean mesh.
  double mollification = 0;
};

// Works on edge lengths alone, mollified as in Sharp and Crane 2020 ("A
// Laplacian for Nonmanifold Triangle Meshes", section 4.5), so degenerate
// triangles and coordinates of any size are no trouble. Any number of faces may
// meet at an edge. REQUIRES: every vertex is used by a face; finite positions
// that are not all equal. O(n log n), deterministic.
Laplacian BuildLaplacian(const TriangleMesh& mesh);

// Area of each face as a share of the mesh's area. Sums to 1.
std::vector<double> FaceAreaShares(const TriangleMesh& mesh);

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_LAPLACIAN_H_
