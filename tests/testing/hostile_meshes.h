// Geometry that is trouble: what no modeller means to send and every service
// gets. All made in code, deterministic, named by a number that stays.
#ifndef MARROW_TESTS_TESTING_HOSTILE_MESHES_H_
#define MARROW_TESTS_TESTING_HOSTILE_MESHES_H_

#include <functional>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

enum class HostileSize {
  kReduced,  // at most some ten thousand faces, for every run of the tests
  kFull,     // up to a million
};

// `make` is not called before the mesh is wanted: a full-size one takes
// hundreds of MB. Unlike a TriangleMesh of core, what it makes may have
// coordinates that are not finite, faces with equal corners and vertices that
// no face uses.
struct HostileMesh {
  std::string name;  // "c46_one_nan": also fit for a test's name
  std::function<TriangleMesh()> make;
};

// Numbers 46 to 82, some in several shapes.
std::vector<HostileMesh> HostileMeshes(HostileSize size);

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_HOSTILE_MESHES_H_
