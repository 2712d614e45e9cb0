// Parts of a server's answer, taken with distrust. Errors are DATA_LOSS and
// say what is wrong.
#ifndef MARROW_CLIENT_ANSWER_PARTS_H_
#define MARROW_CLIENT_ANSWER_PARTS_H_

#include <cstddef>
#include <cstdint>
#include <functional>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "client/segmentation.h"
#include "marrow/v1/segmentation_service.pb.h"

namespace marrow::client {

struct PayloadSize {
  uint32_t num_faces = 0;
  uint32_t num_points = 0;
};

// Whether an id names a segment that was told of.
using KnownId = std::function<bool(uint32_t)>;

template <typename... Args>
absl::Status BrokenAnswer(const Args&... args) {
  return absl::DataLossError(
      absl::StrCat("the server's answer is broken: ", args...));
}

// All but the medial structure and what splits tell.
SegmentNode ToSegmentNode(const v1::Node& node);

// Appends the node's medial points, of which `budget` may still come.
absl::Status TakeMedialPoints(const v1::Node& node, const PayloadSize& size,
                              size_t& budget, SegmentNode& result);

// Appends a chunk of labels.
absl::Status TakeLabels(const v1::Labels& labels, const PayloadSize& size,
                        Level& level);

// Appends joints.
absl::Status TakeJoints(const v1::Skeleton& skeleton, const PayloadSize& size,
                        const KnownId& is_known, Level& level);

// That every face and every point has a label that is known.
absl::Status CheckLabels(const Level& level, const PayloadSize& size,
                         const KnownId& is_known);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_ANSWER_PARTS_H_
