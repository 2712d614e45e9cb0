// Random damage to good meshes, the same for the same seed on any machine.
#ifndef MARROW_TESTS_TESTING_MUTATIONS_H_
#define MARROW_TESTS_TESTING_MUTATIONS_H_

#include <cstdint>
#include <string>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

struct Mutation {
  TriangleMesh mesh;
  // "dumbbell: flip 12 faces, merge 3 vertices": enough to tell what was done.
  std::string history;
  bool has_nan = false;  // a vertex whose position is not a number
};

// One of several small meshes (4 to 640 vertices), after 1 to 5 kinds of
// damage: faces deleted, flipped or duplicated, corners moved to other
// vertices; vertices merged, split, moved a little, far away or onto another,
// or made NaN; copies of the mesh, or specks, added as shells of their own. At
// least a face is left.
Mutation MakeMutation(uint32_t seed);

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_MUTATIONS_H_
