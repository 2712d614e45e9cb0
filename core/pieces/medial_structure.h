// Medial structures of segments (Eq. 8), and the distance to one.
#ifndef MARROW_CORE_PIECES_MEDIAL_STRUCTURE_H_
#define MARROW_CORE_PIECES_MEDIAL_STRUCTURE_H_

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/diffusion/diffusion_map.h"
#include "core/pieces/map_sketch.h"
#include "core/pieces/region.h"

namespace marrow {

// The local vertices of the segment made of the local faces `members` whose
// ADD is within epsilon times the mean ADD of the least; ascending, not empty.
// A segment without area has all its vertices.
std::vector<uint32_t> ComputeMedialStructure(const Region& region,
                                             const DiffusionMap& Phi,
                                             std::span<const uint32_t> members,
                                             double epsilon);

// The squared diffusion distance from a vertex to the nearest point of a medial
// structure, exactly. Only those points are measured whose sketches are near
// enough; large structures have theirs in a k-d tree. The sketch must outlive
// it.
class StructureDistance {
 public:
  StructureDistance(const MapSketch& sketch,
                    const std::vector<uint32_t>& structure);
  ~StructureDistance();
  StructureDistance(StructureDistance&&) noexcept;

  double operator()(uint32_t vertex) const {
    uint32_t point = 0;
    return From(point, vertex);
  }
  // The same, found the quicker the nearer `point` is, a place in the
  // structure; leaves the nearest one in it. Where nothing is nearer than
  // `bound`, that is found out sooner: answers it, and `point` means nothing.
  double From(uint32_t& point, uint32_t vertex,
              double bound = std::numeric_limits<double>::infinity()) const;

 private:
  struct Nearest;
  struct Index;

  const MapSketch* sketch_;
  DiffusionMap points_;
  std::unique_ptr<Index> index_;
};

}  // namespace marrow

#endif  // MARROW_CORE_PIECES_MEDIAL_STRUCTURE_H_
