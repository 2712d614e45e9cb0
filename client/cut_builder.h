// What the events of a call tell of a cut -> a Cut.
#ifndef MARROW_CLIENT_CUT_BUILDER_H_
#define MARROW_CLIENT_CUT_BUILDER_H_

#include <cstddef>
#include <cstdint>
#include <map>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/answer_parts.h"
#include "client/segmentation.h"
#include "marrow/v1/segmentation_service.pb.h"

namespace marrow::client {

// Trusts nothing, as AnswerBuilder does. Not thread safe.
class CutBuilder {
 public:
  explicit CutBuilder(const PayloadSize& size);

  // REQUIRES of the labels and joints: they are of the cut, not of a level.
  absl::Status AddSegments(const v1::CutSegments& segments);
  absl::Status AddLabels(const v1::Labels& labels);
  absl::Status AddJoints(const v1::Skeleton& skeleton);

  // Whether anything was told of a cut.
  bool begun() const { return begun_; }
  // Call once.
  absl::StatusOr<Cut> Finish();

 private:
  absl::Status AddSegment(const v1::Node& segment);
  bool IsKnown(uint32_t id) const { return segments_.contains(id); }

  const PayloadSize size_;
  bool begun_ = false;
  Cut cut_;
  std::map<uint32_t, SegmentNode> segments_;
  uint32_t last_segment_ = kNone;
  size_t medial_budget_;
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_CUT_BUILDER_H_
