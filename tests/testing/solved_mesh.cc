#include "tests/testing/solved_mesh.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "core/operators/laplacian.h"
#include "core/spectrum/solver.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

SolvedMesh Assemble(CanonicalMesh canonical,
                    std::shared_ptr<const EigenPairs> pairs) {
  Adjacency adjacency(canonical.mesh);
  std::vector<double> areas = FaceAreaShares(canonical.mesh);
  const uint32_t usable = pairs->NumPairs() - 1;
  return {std::move(canonical),
          std::move(adjacency),
          std::move(areas),
          {std::move(pairs), usable}};
}

}  // namespace

std::vector<uint32_t> SolvedMesh::AllFaces() const {
  std::vector<uint32_t> all(canonical.mesh.NumFaces());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

SolvedMesh SolveMesh(const TriangleMesh& mesh, uint32_t count) {
  const CancelToken cancel;
  CanonicalMesh canonical = CanonicalOf(mesh);
  auto pairs =
      SolverEigenPairSource().Get(canonical, count, cancel, nullptr).value();
  return Assemble(std::move(canonical), std::move(pairs));
}

SolvedMesh PretendToSolve(const TriangleMesh& mesh, uint32_t count) {
  CanonicalMesh canonical = CanonicalOf(mesh);
  auto pairs = std::make_shared<EigenPairs>();
  pairs->area = canonical.report.area;
  pairs->complete = true;
  pairs->eigenvalues.setLinSpaced(count + 1, 0, 0.1 * count);
  pairs->eigenvectors.setOnes(canonical.mesh.NumVertices(), count + 1);
  for (uint32_t v = 0; v < canonical.mesh.NumVertices(); ++v)
    for (uint32_t k = 1; k <= count; ++k)
      pairs->eigenvectors(v, k) =
          std::sin(k * canonical.mesh.positions(v, k % 3) + k);
  return Assemble(std::move(canonical), std::move(pairs));
}

}  // namespace marrow
