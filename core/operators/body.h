// What is computed on together.
#ifndef MARROW_CORE_OPERATORS_BODY_H_
#define MARROW_CORE_OPERATORS_BODY_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/canonical_mesh.h"
#include "core/mesh/coarse_mesh.h"
#include "core/operators/bridges.h"

namespace marrow {

// core/operators/bodies.h has the rules by which it is made, and their numbers.
struct Body {
  // A submesh, its shells sewn, or, where there is one component, the whole
  // mesh itself, which must then outlive this.
  std::shared_ptr<const CanonicalMesh> canonical;
  // It with its holes patched: the same vertices, the same faces, and then the
  // patches. Null for what is no sieve.
  std::shared_ptr<const CanonicalMesh> patched;
  std::shared_ptr<const CoarseMesh> coarse;  // of Patched(); null for most
  std::vector<uint32_t> faces;  // own face -> the whole mesh's, ascending
  // Own vertex -> the whole mesh's, ascending; the same for several where
  // shells that touch were parted.
  std::vector<uint32_t> vertices;
  bool is_parted = false;       // where any of the whole mesh's shells were
  std::vector<Bridge> bridges;  // between its shells, own vertices
  // Vertices of the whole mesh that are one of this: the one that `vertices`
  // has, and another; ascending.
  std::vector<Bridge> seams;
  // Of the area of all bodies, scenery counting as rule 5 says.
  double share = 1;

  const CanonicalMesh& Patched() const {
    return patched == nullptr ? *canonical : *patched;
  }
  // What is computed on.
  const CanonicalMesh& Computed() const {
    return coarse == nullptr ? Patched() : coarse->canonical;
  }
};

// Of some faces of a mesh, ascending, with its share left at 1; the rims of its
// shells are sewn, where it has several. Errors: CANCELLED.
absl::StatusOr<Body> MakeBody(const TriangleMesh& mesh,
                              std::vector<uint32_t> faces, bool has_shells,
                              bool are_shreds, const CancelToken& cancel);

// By face that is computed on, whether it is a patch and of no face of the
// body; empty where none is.
std::vector<bool> PatchesOf(const Body& body);

// Vertices of a body in the whole mesh, ascending: of those that were sewn
// together one that is a corner of `faces`, faces of the whole mesh, where
// there is one. `own` ascending.
std::vector<uint32_t> ToWholeVertices(const Body& body,
                                      const TriangleMesh& whole,
                                      std::vector<uint32_t> own,
                                      const std::vector<uint32_t>& faces);

// How many of the `count` pairs asked for a body has: its share of them, as
// the shortest wave that they can tell is then the same on all bodies, but
// enough for a level or two.
uint32_t PairsOfBody(const Body& body, uint32_t count);

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_BODY_H_
