// Medial structures -> segments: competing fronts (Eq. 9 and 11).
#ifndef MARROW_CORE_PIECES_FRONTS_H_
#define MARROW_CORE_PIECES_FRONTS_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pieces/map_sketch.h"
#include "core/pieces/region.h"
#include "core/spectrum/team.h"

namespace marrow {

// A medial structure: local vertices, ascending.
using Structure = std::vector<uint32_t>;

// What StructureDistance says of a vertex and one of the structures.
struct FrontDistance {
  uint32_t front = kNoIndex;  // none
  uint32_t point = 0;         // of the structure, about the nearest
  double distance = 0;
};

// Calls body(first, end) for ranges that make up 0 to count; for some of them
// only, once `cancel` is.
void ForRanges(Team& team, uint32_t count, const CancelToken& cancel,
               const std::function<void(uint32_t, uint32_t)>& body);

// The distance of each vertex to the structure that `front` names for it: what
// CompeteFronts may be told to know. Of no use once `cancel` is.
std::vector<FrontDistance> DistancesTo(const MapSketch& sketch,
                                       const std::vector<Structure>& structures,
                                       const std::vector<uint32_t>& front,
                                       const CancelToken& cancel, Team& team);

// Local face -> the structure (front) that claims it: faces leave a heap in the
// order of (Eq. 11, local face, front), which is total, so the result does not
// depend on the heap. Faces that no front reaches go, a connected piece of the
// region as a whole, to the front whose greatest distance over the piece is
// least. Returns early, with anything, once `cancel` is. `known`, an entry a
// vertex or empty, saves computing these distances anew.
// REQUIRES: at least one structure, none empty.
std::vector<uint32_t> CompeteFronts(const Region& region,
                                    const MapSketch& sketch,
                                    const std::vector<Structure>& structures,
                                    const CancelToken& cancel,
                                    std::vector<FrontDistance> known = {});

}  // namespace marrow

#endif  // MARROW_CORE_PIECES_FRONTS_H_
