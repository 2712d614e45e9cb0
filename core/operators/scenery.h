// What stands around a creature: the ground, a box, a dome.
#ifndef MARROW_CORE_OPERATORS_SCENERY_H_
#define MARROW_CORE_OPERATORS_SCENERY_H_

#include <cstdint>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Which of the components, sets of faces, are scenery. Those that reach
// farthest from their middle are looked at first, eight at most, until one is
// none: scenery reaches at least kScenerySize times as far as all others that
// are none together do from theirs, and
//  - has no more than kPlainFaces faces, and the others a hundred times as
//    many, or
//  - is flat, and has no more than kFlatShare times their faces, or
//  - lies all around the others, and has no more than kEnclosingShare times
//    their faces.
// A limb, a garment or a body under its hair is none of these. There is always
// a component that is not scenery. Distances are from the mean of the vertices,
// so that turning, moving and scaling changes nothing. Of no use once
// cancelled. Linear but for sorting the components.
std::vector<bool> FindScenery(
    const TriangleMesh& mesh,
    const std::vector<std::vector<uint32_t>>& components,
    const CancelToken& cancel = CancelToken());

inline constexpr double kScenerySize = 2;
inline constexpr uint32_t kPlainFaces = 100;
inline constexpr double kPlainShare = 0.01;
inline constexpr double kFlatShare = 2;
inline constexpr double kEnclosingShare = 0.5;

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_SCENERY_H_
