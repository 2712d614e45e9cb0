// A whole run over a mesh made in code, and what to compare of two.
#ifndef MARROW_TESTS_TESTING_RUN_H_
#define MARROW_TESTS_TESTING_RUN_H_

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/options.h"
#include "tests/testing/recording_sink.h"

namespace marrow {

// So many levels of 100 pairs, all else at its default but the method.
SegmentationOptions Levels(uint32_t levels, Method method = Method::kPaper);

// Encodes, solves and segments. Fails the test where Run() fails.
RecordingSink RunOn(const TriangleMesh& mesh,
                    const SegmentationOptions& options);

// All but the numbering of the payload is equal, to the last bit.
void ExpectSameTree(const SegmentTree& a, const SegmentTree& b);
void ExpectSameSkeleton(const Skeleton& a, const Skeleton& b);

// The share of pairs of faces that are together in one labelling and apart in
// the other. REQUIRES: equal, positive sizes.
double RandIndexDifference(const std::vector<uint32_t>& a,
                           const std::vector<uint32_t>& b);

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_RUN_H_
