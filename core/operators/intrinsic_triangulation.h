// A closed surface of triangles that has lengths but no positions, and the
// edge flips that make it Delaunay.
//
// Mollification: Sharp and Crane 2020, "A Laplacian for Nonmanifold Triangle
// Meshes", section 4.5. Intrinsic Delaunay triangulation by flips: Bobenko and
// Springborn 2007, "A Discrete Laplace-Beltrami Operator for Simplicial
// Surfaces"; Fisher et al. 2007, "An Algorithm for the Construction of
// Intrinsic Delaunay Triangulations with Applications to Digital Geometry
// Processing".
#ifndef MARROW_CORE_OPERATORS_INTRINSIC_TRIANGULATION_H_
#define MARROW_CORE_OPERATORS_INTRINSIC_TRIANGULATION_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/operators/tufted_cover.h"

namespace marrow {

// Triangles may share two edges or more, an edge may return to the vertex where
// it began, and a triangle may be glued to itself. Not thread safe.
class IntrinsicTriangulation {
 public:
  // Lengths carry more digits than a double, because the area of a flat
  // triangle hangs on the last digits of its sides.
  using Real = long double;

  struct Edge {
    std::array<uint32_t, 2> ends;
    double weight;  // half the sum of the two cotangents opposite
  };

  // `lengths` has an entry for each edge of the mesh, not negative.
  IntrinsicTriangulation(GluedTriangles glued,
                         const std::vector<Real>& lengths);

  // Adds the least constant to all lengths that leaves the two shorter sides of
  // every triangle longer than the third by `slack`; returns it.
  Real Mollify(Real slack);

  // Flips edges until opposite angles sum to at most 180 degrees at each, but
  // for rounding, in which case weights are >= 0; returns how many flips it
  // took. Errors: CANCELLED; RESOURCE_EXHAUSTED where `max_flips` do not do.
  absl::StatusOr<uint64_t> FlipToDelaunay(uint64_t max_flips,
                                          const CancelToken& cancel);

  uint64_t NumEdges() const { return edge_sides_.size(); }
  // Without those that return to their vertex, which weigh nothing. Weights
  // that rounding alone makes negative are 0. REQUIRES: the last change was
  // FlipToDelaunay().
  std::vector<Edge> WeightedEdges() const;
  // A third of the area around each of n vertices.
  Eigen::VectorXd VertexAreas(uint32_t n) const;

 private:
  // What the edge and its opposite angle look like from one of its sides.
  struct Corner {
    Real scaled_cotangent;
    Real area;
  };

  Corner OppositeCorner(uint32_t side) const;
  Real CotangentSum(uint32_t e) const;
  bool IsDelaunay(uint32_t e) const;
  Real LengthOfFlipped(uint32_t e) const;
  void Flip(uint32_t e);

  // Invariants:
  // 1. Every side is in one edge, and every edge has two sides, which run
  //    between the same two vertices in opposite directions.
  // 2. The sides of a triangle obey the triangle inequality, but for rounding.
  // 3. A flip changes no distance on the surface, but for rounding.
  // By side, so that what belongs to a triangle lies together.
  std::vector<uint32_t> corners_;  // the vertex where it begins
  std::vector<uint32_t> side_edge_;
  std::vector<Real> lengths_;  // both sides of an edge have the same
  std::vector<std::array<uint32_t, 2>> edge_sides_;
};

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_INTRINSIC_TRIANGULATION_H_
