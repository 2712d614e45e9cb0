// The events of one Segment or Cut call -> what they tell.
#ifndef MARROW_CLIENT_ANSWER_BUILDER_H_
#define MARROW_CLIENT_ANSWER_BUILDER_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/answer_parts.h"
#include "client/cut_builder.h"
#include "client/segmentation.h"
#include "marrow/v1/segmentation_service.pb.h"

namespace marrow::client {

// Trusts nothing that a server says: what Finish() returns is a tree whose ids
// are unique and whose links agree, with one label a face and a point that is
// the id of a node, and skeletons whose parents stand first. Memory is bounded
// by the payload's size. Not thread safe. Errors are DATA_LOSS and say what
// was wrong in the answer.
class AnswerBuilder {
 public:
  // The payload that was sent has this many faces and points.
  AnswerBuilder(uint32_t num_faces, uint32_t num_points);

  // Takes the next event of the stream.
  absl::Status Add(const v1::SegmentEvent& event);
  // One more, that no event told.
  void AddWarning(const v1::Warning& warning);

  // Call once, after the stream ended well. Faces and vertices are those of
  // the payload as it decodes.
  absl::StatusOr<Segmentation> Finish();
  // The same for the stream of a Cut call.
  absl::StatusOr<CutAnswer> FinishCut();

 private:
  absl::Status AddLevel(const v1::Level& level);
  absl::Status BeginLevel(uint32_t level);
  absl::Status AddNode(const v1::Node& node);
  absl::Status BeginNode(const v1::Node& node);
  absl::Status AddSplit(const v1::Split& split);
  absl::Status AddLabels(const v1::Labels& labels);
  absl::Status AddSkeleton(const v1::Skeleton& skeleton);
  absl::Status AddCompleted(const v1::Completed& completed);
  absl::StatusOr<Level*> LevelOf(uint32_t level);
  absl::Status CheckTree() const;

  const PayloadSize size_;
  uint64_t sequence_ = 0;
  bool completed_ = false;
  std::map<uint32_t, SegmentNode> nodes_;
  std::vector<Level> levels_;  // level i + 1 at i
  // Of the newest level: whether labels or joints have come, the node that
  // came last, and how many medial points may still come.
  bool level_ended_ = false;
  uint32_t last_node_ = kNone;
  size_t medial_budget_ = 0;
  CutBuilder cut_;
  nlohmann::json report_ = nlohmann::json::object();
  nlohmann::json warnings_ = nlohmann::json::array();
  nlohmann::json timings_ = nlohmann::json::object();
  nlohmann::json cache_ = nlohmann::json::object();
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_ANSWER_BUILDER_H_
