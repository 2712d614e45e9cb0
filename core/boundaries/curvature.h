// Gaussian curvature at several widths: where a surface is saddle-shaped.
#ifndef MARROW_CORE_BOUNDARIES_CURVATURE_H_
#define MARROW_CORE_BOUNDARIES_CURVATURE_H_

#include <array>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// At these positions instead of the mesh's own, in their units.
double AreaAt(const TriangleMesh& mesh, const Positions& positions);

// The positions moved and scaled so that the mesh has area 1. All lengths of
// this folder are in that unit. REQUIRES: a face of positive area.
Positions UnitAreaPositions(const TriangleMesh& mesh);

// Gaussian curvature of a mesh of area 1, smoothed over the surface.
//
// The angle defects K (2 pi less the angles around a vertex) are spread by
// implicit steps of heat flow, (M + (w'^2 - w^2) L) k' = M k, from each width w
// to the next, w', which is twice as wide, from 0 and kLeastWidth on. A step
// keeps the total and makes neither a new maximum nor a new minimum on meshes
// without obtuse angles. It uses edge lengths alone, so bending changes
// nothing. Vertices at a boundary of the mesh, other than that of a small hole,
// or at an edge of three or more faces have no defect. Widths at which there is
// hardly anything but noise (the total of |K| falls too fast towards the next)
// have the values of the first that is wider.
//
// Immutable, hence thread safe.
class Curvature {
 public:
  static constexpr double kLeastWidth = 0.0025;
  static constexpr uint32_t kNumWidths = 7;

  // Errors: CANCELLED; those of BuildLaplacian(). Deterministic; time
  // grows with the mesh.
  static absl::StatusOr<Curvature> Measure(const TriangleMesh& mesh,
                                           const Adjacency& adjacency,
                                           const CancelToken& cancel);

  // Curvature at a vertex, linear in the logarithm of the width between the
  // widths that are there, constant beyond them.
  double At(uint32_t vertex, double width) const;

 private:
  // `total` of |K| over the surface, at each width.
  void DropNoise(const std::array<double, kNumWidths>& total);

  // Vertex v at width i is entry v * kNumWidths + i.
  std::vector<double> values_;
};

// 2 pi less the sum of the angles at each vertex; 0 where it is not inside a
// manifold part of the surface. Small holes (core/mesh/rims.h), as scans have
// them, are taken to be filled with flat faces.
std::vector<double> AngleDefects(const TriangleMesh& mesh,
                                 const Adjacency& adjacency);

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_CURVATURE_H_
