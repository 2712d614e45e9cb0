// An order of the unknowns that keeps a factorisation sparse.
#ifndef MARROW_CORE_SPECTRUM_ORDERING_H_
#define MARROW_CORE_SPECTRUM_ORDERING_H_

#include <Eigen/Core>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"

namespace marrow {

// The graph of a symmetric matrix without its diagonal: the neighbours of v are
// neighbours[start[v]] up to neighbours[start[v + 1]].
struct Graph {
  std::vector<int> start;
  std::vector<int> neighbours;
  int NumVertices() const { return static_cast<int>(start.size()) - 1; }
};

// new -> old. Nested dissection: a set of vertices is cut in two by a plane or
// by distance in the graph, whichever leaves the smaller separator; the
// separator comes after both halves. `positions` has a row of three a vertex.
// Vertices with very many neighbours come last. Deterministic, whatever
// `threads`; O(n log n). Errors: CANCELLED.
absl::StatusOr<std::vector<int>> DissectionOrder(const Graph& graph,
                                                 const double* positions,
                                                 int threads,
                                                 const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_ORDERING_H_
