// A sample creature as a mesh of core, with the part of every face.
#ifndef MARROW_TESTS_TESTING_CREATURE_MESH_H_
#define MARROW_TESTS_TESTING_CREATURE_MESH_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

struct CreatureMesh {
  TriangleMesh mesh;
  std::vector<uint32_t> parts;  // a face
};

// In the rest pose, with the fewest faces. REQUIRES: a sample's name.
CreatureMesh MakeCreature(const std::string& name);

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_CREATURE_MESH_H_
