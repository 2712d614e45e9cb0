// Draco bytes for tests of whatever starts from a payload.
#ifndef MARROW_TESTS_TESTING_DRACO_ENCODE_H_
#define MARROW_TESTS_TESTING_DRACO_ENCODE_H_

#include <string>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

enum class Precision { kFloat, kDouble };

// Sequential, without quantization: decodes to the same points and faces in
// the same order. Positions are rounded to float, or sent as doubles.
std::string EncodeDraco(const TriangleMesh& mesh,
                        Precision precision = Precision::kFloat);

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_DRACO_ENCODE_H_
