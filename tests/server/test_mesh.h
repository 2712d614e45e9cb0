// Closed meshes made in code, as Draco payloads.
#ifndef MARROW_TESTS_SERVER_TEST_MESH_H_
#define MARROW_TESTS_SERVER_TEST_MESH_H_

#include <string>

namespace marrow::testing {

// A ball with five arms, subdivided `depth` times: 10 * 4^depth + 2 vertices.
// `stretch` scales it along x, which makes another geometry of it.
std::string StarPayload(int depth, double stretch = 1);

}  // namespace marrow::testing

#endif  // MARROW_TESTS_SERVER_TEST_MESH_H_
