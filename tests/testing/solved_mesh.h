// A mesh with everything that splitting needs.
#ifndef MARROW_TESTS_TESTING_SOLVED_MESH_H_
#define MARROW_TESTS_TESTING_SOLVED_MESH_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "core/mesh/adjacency.h"
#include "core/mesh/canonical_mesh.h"
#include "core/pieces/split_region.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

struct SolvedMesh {
  CanonicalMesh canonical;
  Adjacency adjacency;
  std::vector<double> areas;  // shares
  PulledPairs pulled;         // all of them usable

  // Refers to this object.
  SplitContext context() const {
    return {canonical.mesh, adjacency, pulled, areas};
  }
  std::vector<uint32_t> AllFaces() const;
};

// With `count` pairs besides the constant one. REQUIRES: the mesh has area.
SolvedMesh SolveMesh(const TriangleMesh& mesh, uint32_t count = 100);

// With pairs that were never solved for: smooth functions of the position, at
// no cost. For tests of time and of numbers that any map may have.
SolvedMesh PretendToSolve(const TriangleMesh& mesh, uint32_t count);

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_SOLVED_MESH_H_
