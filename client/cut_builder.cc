#include "client/cut_builder.h"

#include <utility>

#include "core/base/status_macros.h"

namespace marrow::client {

// A vertex lies in at most as many segments as it has faces.
CutBuilder::CutBuilder(const PayloadSize& size)
    : size_(size), medial_budget_(size_t{3} * size.num_faces) {}

absl::Status CutBuilder::AddSegments(const v1::CutSegments& segments) {
  begun_ = true;
  cut_.salience = segments.salience();
  cut_.tree_nodes = segments.tree_nodes();
  for (const v1::Node& segment : segments.segments()) {
    MARROW_RETURN_IF_ERROR(AddSegment(segment));
  }
  return absl::OkStatus();
}

absl::Status CutBuilder::AddSegment(const v1::Node& segment) {
  if (segment.id() != last_segment_) {
    if (segments_.size() >= size_.num_faces) {
      return BrokenAnswer("the cut has more segments than there are faces");
    }
    if (!segments_.emplace(segment.id(), ToSegmentNode(segment)).second) {
      return BrokenAnswer("segment ", segment.id(), " of the cut came twice");
    }
    last_segment_ = segment.id();
  }
  return TakeMedialPoints(segment, size_, medial_budget_,
                          segments_[segment.id()]);
}

absl::Status CutBuilder::AddLabels(const v1::Labels& labels) {
  if (!begun_) return BrokenAnswer("labels of a cut came before it");
  return TakeLabels(labels, size_, cut_.level);
}

absl::Status CutBuilder::AddJoints(const v1::Skeleton& skeleton) {
  if (!begun_) return BrokenAnswer("the skeleton of a cut came before it");
  return TakeJoints(
      skeleton, size_, [this](uint32_t id) { return IsKnown(id); }, cut_.level);
}

absl::StatusOr<Cut> CutBuilder::Finish() {
  if (!begun_) return BrokenAnswer("it lacks the cut that was asked for");
  MARROW_RETURN_IF_ERROR(CheckLabels(
      cut_.level, size_, [this](uint32_t id) { return IsKnown(id); }));
  for (auto& [id, segment] : segments_) {
    cut_.segments.push_back(std::move(segment));
  }
  return std::move(cut_);
}

}  // namespace marrow::client
