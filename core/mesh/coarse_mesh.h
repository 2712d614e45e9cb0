// A mesh -> the same surface with fewer vertices, and the way back.
#ifndef MARROW_CORE_MESH_COARSE_MESH_H_
#define MARROW_CORE_MESH_COARSE_MESH_H_

#include <cstdint>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/mesh/canonical_mesh.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Immutable once built. "Fine" is the mesh that it was made from.
struct CoarseMesh {
  // As in Submesh: in canonical order, turned as the fine one, with a digest.
  CanonicalMesh canonical;
  std::vector<uint32_t> vertices;  // coarse vertex -> that fine one, ascending
  std::vector<uint32_t> faces;     // coarse face -> a fine face of its cluster
  // Fine face -> the coarse face whose cluster it is of.
  std::vector<uint32_t> coarse_face;
};

// Collapses short edges into one of their ends, round after round, until
// `num_vertices` are left, or until hardly any edge can go. The vertices that
// are left lie evenly on the surface.
//
// Keeps the topology: an edge goes only where the ends have no other neighbours
// in common than its faces do (the link condition, Dey, Edelsbrunner, Guha and
// Nekhayev 1999); boundaries stay boundaries, and vertices where the mesh is no
// manifold stay. No collapse turns a face by more than 60 degrees or makes it a
// sliver, unless too many vertices are left by that; then more is allowed. The
// clusters of fine faces partition the fine mesh, each is connected across
// edges, and two coarse faces that share an edge have clusters that do: so what
// is connected on the coarse mesh is connected on the fine one.
//
// A mesh that is moved, turned, mirrored or scaled has the same coarse mesh,
// but for some vertices in a hundred where its positions were rounded to float,
// and for those that a symmetry of the mesh exchanges.
//
// `mesh` is canonical. Of no use once cancelled. Deterministic; a round is
// linear in the mesh but for sorting, however many faces a vertex has. Thread
// safe.
CoarseMesh Coarsen(const TriangleMesh& mesh, uint32_t num_vertices,
                   const CancelToken& cancel = CancelToken());

}  // namespace marrow

#endif  // MARROW_CORE_MESH_COARSE_MESH_H_
