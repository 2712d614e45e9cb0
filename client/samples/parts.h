// Which part of a creature every face of its skin belongs to.
#ifndef MARROW_CLIENT_SAMPLES_PARTS_H_
#define MARROW_CLIENT_SAMPLES_PARTS_H_

#include <cstdint>
#include <vector>

#include "client/samples/field.h"
#include "client/samples/polygonize.h"

namespace marrow {

// A face belongs to the part whose own surface is nearest to its centre: at
// the root of a limb, the border of two parts is the crease. The faces of a
// part are joined through edges: a few that the crease's zigzag cut off go to
// the part around them. `mesh` is closed and in the rest pose.
std::vector<uint32_t> PartsOfFaces(const CreatureField& field,
                                   const SurfaceMesh& mesh);

}  // namespace marrow

#endif  // MARROW_CLIENT_SAMPLES_PARTS_H_
