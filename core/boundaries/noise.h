// Noise on a surface, and the surface without it.
//
// A scanner moves every vertex by itself, so the bumps of neighbours have
// nothing in common, whereas those of a shape agree, however coarse its
// triangles are. On a noisy surface lengths, areas and angles say little of the
// shape; its eigen-pairs, which only the lowest waves enter, still do.
#ifndef MARROW_CORE_BOUNDARIES_NOISE_H_
#define MARROW_CORE_BOUNDARIES_NOISE_H_

#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// How far the bumps of neighbours agree, -1 to 1. A bump is how far the mean of
// a vertex's neighbours stands out along the vertex's normal; this is the sum
// of its products with the mean bump of the neighbours over the sum of its
// squares. On smooth surfaces it is near 1, after decimation 0.3 to 0.8, about
// a third where flat faces were divided, -0.1 with noise of a fifth of the mean
// edge and -0.2 with any more. 1 where bumps are below a thousandth of an edge.
//
// REQUIRES: a face of positive area. Deterministic, O(n log n). Neither scale
// nor place matters, nor which way faces are turned: those of a part
// (core/mesh/orientation.h) are taken to agree.
double BumpAgreement(const TriangleMesh& mesh, const Adjacency& adjacency);

// The mesh itself where the bumps agree as on a shape; else with its vertices
// moved by kCalmSteps steps of Taubin's smoothing (1995), which takes away
// waves of a few edges and keeps the size. The faces stay. What next to nothing
// would be left of stays too. REQUIRES and promises as above.
TriangleMesh WithoutNoise(const TriangleMesh& mesh, const Adjacency& adjacency);

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_NOISE_H_
