// Rims: where a surface ends.
#ifndef MARROW_CORE_MESH_RIMS_H_
#define MARROW_CORE_MESH_RIMS_H_

#include <cstdint>
#include <vector>

#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Vertices at edges of one face, ascending.
std::vector<uint32_t> RimVertices(const Adjacency& adjacency);

// A rim is a set of edges of one face each that shared vertices connect; rims
// that touch are one. For each vertex the least of its rim; itself where it is
// on none.
std::vector<uint32_t> RimOfVertices(const Adjacency& adjacency);

// Holes that are small, as scans have them.
struct Holes {
  // A vertex at a hole, and the angle there between its two edges.
  struct Corner {
    uint32_t vertex;
    double angle;
  };
  std::vector<Corner> corners;
  std::vector<bool> has_edge;  // by edge; no edge is of two holes
};

// First every hole of three edges, so that two that touch in a vertex are two;
// of the rest each that is one simple loop, no longer than `longest`, in units
// of `positions`, and nearly flat and convex. A face alone is no hole.
// Deterministic. O(n^1.5) at the worst, linear where few rims meet in a vertex.
Holes SmallHoles(const Adjacency& adjacency, const Positions& positions,
                 double longest);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_RIMS_H_
