// Which components of a mesh are computed on together, which are segments of
// their own, and which follow another: the one place that decides it.
//
// A component is what shared vertices connect, after welding; but closed shells
// of kWeight that touch in vertices alone are one each, and weigh together
// (core/mesh/touching_shells.h). Its size is its share of the area of what is
// not scenery (core/operators/scenery.h): however large the ground that a
// creature stands on, it makes no difference to the rules. In order:
//  1. Of weight is a component of at least kWeight, or of kBodyShare of the
//     largest if that is less, but at least kLightWeight. Where those hold less
//     than kMainShare of the area (a creature of scales or plates, not one with
//     a body under its hair), of at least kLightWeight; the largest always is.
//     A component of weight that lies all over on larger ones, within the
//     distance of rule 2, is worn (core/operators/attachment.h): it would be
//     cut where it is, not where that is. None is where they hold together what
//     rule 2 would part without them.
//  2. Components of weight no farther apart than BridgingDistance() of all of
//     weight, nor than kBridgedGap of the widest (a row of creatures is wide,
//     and no creature for that), are one body, through any number of others. A
//     body has one operator, one spectrum and one tree: it is segmented as if
//     its shells had grown together. Their rims are sewn where they face each
//     other (core/operators/seams.h), and what stays apart is bridged.
//     Shreds are kFewestShreds components or more, up to 250,000, with a rim
//     edge for every three faces at least, of kFacesOfShred faces on average at
//     most and none of kMainShare of the area: a surface whose faces, or
//     scales, shrank or were moved apart. They are all of weight,
//     however small, for a sieve conducts nothing; they are one body no farther
//     apart than kShredGap of their mean breadth, as dust is no creature; and
//     they are sewn as shreds.
//  3. A body of at least kBodyShare of the largest is a segment of its own, a
//     child of the root, if there are several; of the kMaxBodies largest.
//  4. Whatever is left, an eye, a strap, a speck, is attached: a component, or
//     a body that is too small for rule 3, has at every level the label of the
//     face in the midst of where it is nearest to the bodies, by points
//     (surface_points.h); each face of what is worn that of the face nearest
//     to it. It enters no operator, so a mesh with specks, or in clothes, is
//     segmented exactly as without.
//  5. Scenery is a body each, that counts for kSceneryShare of the largest.
//     Nothing is attached to it.
//  6. The small holes of a sieve, a body that takes kSievePatches faces a face
//     or more, are patched (core/mesh/patches.h): of a surface with very many
//     holes, eigen-pairs, curvature and boundaries tell little, while fewer do
//     no harm. Patches are computed on, and no more: they have no label. But
//     what they join is in one piece.
//  7. A body of more than kLargeBody vertices is computed on a coarse mesh of
//     about kCoarseVertices (core/mesh/coarse_mesh.h): its parts are far larger
//     than what that leaves out. Not where half of the vertices cannot go.
#ifndef MARROW_CORE_OPERATORS_BODIES_H_
#define MARROW_CORE_OPERATORS_BODIES_H_

#include <cstdint>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/mesh/canonical_mesh.h"
#include "core/operators/body.h"

namespace marrow {

inline constexpr double kWeight = 1e-2;
inline constexpr double kLightWeight = 1e-4;
inline constexpr double kMainShare = 0.05;
inline constexpr double kBridgedGap = 0.1;
inline constexpr size_t kFewestShreds = 200;
inline constexpr uint64_t kFacesOfShred = 32;
// Triangles that shrank to .7 stand a quarter of their breadth apart.
inline constexpr double kShredGap = 0.5;
inline constexpr double kBodyShare = 0.05;
inline constexpr uint32_t kMaxBodies = 128;
// One face in a hundred missing changes next to nothing, one in ten a lot.
inline constexpr double kSievePatches = 0.04;
inline constexpr double kSceneryShare = 0.05;
inline constexpr uint32_t kLargeBody = 80'000;
inline constexpr uint32_t kCoarseVertices = 40'000;

// Immutable once built.
struct Bodies {
  std::vector<Body>
      bodies;  // by falling area, then least face, scenery last; not empty
  // Face of the whole mesh -> itself where a body has it, else the face of a
  // body whose labels it takes (rule 4).
  std::vector<uint32_t> anchors;

  // Whether the whole mesh is one body, so that nothing need be mapped.
  bool IsWhole() const {
    return bodies.size() == 1 && bodies[0].faces.size() == anchors.size() &&
           bodies[0].seams.empty() && !bodies[0].is_parted;
  }
  // Whether what is computed on is the whole mesh.
  bool IsComputedWhole() const {
    return IsWhole() && &bodies[0].Computed() == bodies[0].canonical.get();
  }
};

// Takes the rules above to a mesh, and notes in its report what came of them.
// Deterministic, O(n log^2 n). Neither the result nor what is noted is of use
// once cancelled. Thread safe.
Bodies FindBodies(CanonicalMesh& mesh,
                  const CancelToken& cancel = CancelToken());

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_BODIES_H_
