// The shape of a cut: a loop around a limb, or pieces of a seam along one.
#ifndef MARROW_CORE_BOUNDARIES_LOOPS_H_
#define MARROW_CORE_BOUNDARIES_LOOPS_H_

#include <cstdint>
#include <functional>
#include <span>

#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

struct LoopShape {
  // 4 pi A / L^2 of each closed loop, weighted by its share of the length: 1
  // for a circle, less where it is flat, bent out of its plane or open. A is
  // the norm of its vector area, L its length.
  double roundness = 0;
  // The share of the length that the longest connected part has.
  double largest = 0;
};

// `edges` are those between faces for which `inside` holds and others; loops
// run around the former as their corners do. No edges: both 0.
LoopShape ShapeOfLoops(const TriangleMesh& mesh, const Adjacency& adjacency,
                       const Positions& positions,
                       std::span<const uint32_t> edges,
                       const std::function<bool(uint32_t)>& inside);

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_LOOPS_H_
