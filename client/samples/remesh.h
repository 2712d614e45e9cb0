// Well-shaped triangles, and as many as asked for.
#ifndef MARROW_CLIENT_SAMPLES_REMESH_H_
#define MARROW_CLIENT_SAMPLES_REMESH_H_

#include <cstdint>

#include "absl/status/status.h"
#include "client/samples/field.h"
#include "client/samples/polygonize.h"

namespace marrow {

// Collapses the shortest edges, measured against the square root of the local
// thickness, until `faces` (even) are left. Keeps a closed manifold closed,
// manifold and of the same genus. INTERNAL if it runs out of edges that may
// be collapsed.
absl::Status CollapseTo(uint32_t faces, const CreatureField& field,
                        SurfaceMesh& mesh);

// Moves the vertices along the surface towards their neighbours' mean and
// flips edges to Delaunay, so that triangles become nearly equilateral. The
// counts of vertices and faces stay.
void Relax(const CreatureField& field, int rounds, SurfaceMesh& mesh);

}  // namespace marrow

#endif  // MARROW_CLIENT_SAMPLES_REMESH_H_
