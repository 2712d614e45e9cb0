// Boundaries between pieces, moved to where people would draw them.
#ifndef MARROW_CORE_BOUNDARIES_BOUNDARY_MOVER_H_
#define MARROW_CORE_BOUNDARIES_BOUNDARY_MOVER_H_

#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/boundaries/curvature.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pieces/face_links.h"

namespace marrow {

// Moves every boundary between two pieces to the cheapest place in a band on
// either side of it, pair after pair, kMovePasses times over. A cut along an
// edge costs
//
//   length (1 + kCreaseDiscount tanh(K r^2 / kCreaseCurvature)),
//
// K being the Gaussian curvature at width kCreaseWidth r: short cuts are cheap,
// all the more where the surface is saddle-shaped, so that boundaries slide
// down a limb into the crease around its base. The band reaches `band_width` r
// from the boundary, r = its length / 2 pi, but leaves of each piece what is
// farther than kBandShare of its farthest point, so that no piece is lost. Then
// strays join their neighbours (core/pieces/stray_pieces.h): pieces are in one
// piece where the mesh is.
//
// Uses edge lengths alone: bending changes nothing. `face_areas` are shares of
// the mesh's area. `piece_of_face` numbers the pieces from 0 without gaps,
// before and after. Deterministic. Errors: CANCELLED.
absl::Status MoveBoundaries(const TriangleMesh& mesh,
                            const Adjacency& adjacency,
                            const std::vector<double>& face_areas,
                            const FaceLinks& links, const Curvature& curvature,
                            double band_width, const CancelToken& cancel,
                            std::vector<uint32_t>& piece_of_face);

// Moves boundaries that are in the right place but for the zigzag of a coarser
// mesh: once each, to where they are shortest, no farther than `breadth` to
// either side (of a mesh of area 1). All else as above.
absl::Status SmoothBoundaries(const TriangleMesh& mesh,
                              const Adjacency& adjacency,
                              const std::vector<double>& face_areas,
                              const FaceLinks& links, double breadth,
                              const CancelToken& cancel,
                              std::vector<uint32_t>& piece_of_face);

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_BOUNDARY_MOVER_H_
