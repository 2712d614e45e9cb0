// Whether the faces of a mesh agree on what is outside.
#ifndef MARROW_CORE_MESH_ORIENTATION_H_
#define MARROW_CORE_MESH_ORIENTATION_H_

#include <cstdint>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Whether the face runs from v to w along their edge.
bool RunsAlong(const Triangle& face, uint32_t v, uint32_t w);

// Which faces agree. A part is what edges of two faces join.
struct Sides {
  std::vector<uint32_t> part;  // face -> part, numbered by their least faces
  // Whether a face is one of the fewer of its part, to turn over so that no two
  // that share an edge alone run along it in one direction; of equally many the
  // least face is not. In a one-sided part some still do.
  std::vector<bool> is_turned;
  std::vector<bool> is_one_sided;  // by part: a Moebius strip

  uint32_t NumParts() const {
    return static_cast<uint32_t>(is_one_sided.size());
  }
};

// O(n log n). Deterministic. Of no use once cancelled. Thread safe.
Sides FindSides(const TriangleMesh& mesh, const Adjacency& adjacency,
                const CancelToken& cancel = CancelToken());

struct Orientation {
  // Of FindSides(). One-sided parts are left out.
  uint64_t flipped_faces = 0;
  bool orientable = true;  // no part is one-sided
};

// As FindSides().
Orientation CheckOrientation(const TriangleMesh& mesh,
                             const Adjacency& adjacency,
                             const CancelToken& cancel = CancelToken());

// The faces to turn over so that those of a part agree and face outwards: the
// volume under them, seen from the mean of their corners, is not negative.
// Where it is zero, those that are turned in `sides`. A part by itself, or
// scaled by a power of two, has the same. Linear, thread safe. Of no use once
// cancelled.
std::vector<bool> FacesInward(const TriangleMesh& mesh, const Sides& sides,
                              const CancelToken& cancel = CancelToken());

}  // namespace marrow

#endif  // MARROW_CORE_MESH_ORIENTATION_H_
