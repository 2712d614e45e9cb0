#include "client/answer_builder.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "client/message_json.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

// Deeper than any server may go (levels: 1 to 8), so that a later server's
// wider range still fits.
constexpr uint32_t kMaxLevels = 64;

// What labels and skeletons call the cut.
constexpr uint32_t kCutLevel = 0;

}  // namespace

AnswerBuilder::AnswerBuilder(uint32_t num_faces, uint32_t num_points)
    : size_{num_faces, num_points}, cut_(size_) {}

absl::Status AnswerBuilder::Add(const v1::SegmentEvent& event) {
  if (event.sequence() != ++sequence_) {
    return BrokenAnswer("event ", event.sequence(), " came in place of ",
                        sequence_);
  }
  if (completed_) return BrokenAnswer("an event came after the last");
  switch (event.event_case()) {
    case v1::SegmentEvent::kMeshReport:
      report_ = ReportJson(event.mesh_report());
      return absl::OkStatus();
    case v1::SegmentEvent::kLevel:
      return AddLevel(event.level());
    case v1::SegmentEvent::kLabels:
      return AddLabels(event.labels());
    case v1::SegmentEvent::kSkeleton:
      return AddSkeleton(event.skeleton());
    case v1::SegmentEvent::kCut:
      return cut_.AddSegments(event.cut());
    case v1::SegmentEvent::kWarning:
      AddWarning(event.warning());
      return absl::OkStatus();
    case v1::SegmentEvent::kCompleted:
      return AddCompleted(event.completed());
    default:  // accepted, progress, and what later servers may add
      return absl::OkStatus();
  }
}

void AnswerBuilder::AddWarning(const v1::Warning& warning) {
  if (warnings_.size() >= size_.num_faces) return;
  warnings_.push_back(
      {{"code", warning.code()}, {"message", warning.message()}});
}

absl::Status AnswerBuilder::AddLevel(const v1::Level& level) {
  if (level_ended_ || level.level() != levels_.size()) {
    MARROW_RETURN_IF_ERROR(BeginLevel(level.level()));
  }
  for (const v1::Node& node : level.nodes()) {
    MARROW_RETURN_IF_ERROR(AddNode(node));
  }
  for (const v1::Split& split : level.splits()) {
    MARROW_RETURN_IF_ERROR(AddSplit(split));
  }
  return absl::OkStatus();
}

absl::Status AnswerBuilder::BeginLevel(uint32_t level) {
  if (level != levels_.size() + 1 || level > kMaxLevels) {
    return BrokenAnswer("level ", level, " came after ", levels_.size());
  }
  levels_.emplace_back().level = level;
  level_ended_ = false;
  last_node_ = kNone;
  // A vertex lies in at most as many segments as it has faces, and with level
  // 1 the root comes too.
  medial_budget_ = size_t{6} * size_.num_faces;
  return absl::OkStatus();
}

absl::Status AnswerBuilder::AddNode(const v1::Node& node) {
  if (node.id() != last_node_ || node.has_parent()) {
    MARROW_RETURN_IF_ERROR(BeginNode(node));
  }
  return TakeMedialPoints(node, size_, medial_budget_, nodes_[node.id()]);
}

absl::Status AnswerBuilder::BeginNode(const v1::Node& node) {
  // The nodes of a level share out the faces, so a level over m faces has at
  // most m, and the root comes before the first.
  if (nodes_.size() > levels_.size() * size_.num_faces)
    return BrokenAnswer("too many nodes");
  if (!nodes_.emplace(node.id(), ToSegmentNode(node)).second) {
    return BrokenAnswer("node ", node.id(), " came twice");
  }
  last_node_ = node.id();
  return absl::OkStatus();
}

absl::Status AnswerBuilder::AddSplit(const v1::Split& split) {
  const auto it = nodes_.find(split.id());
  if (it == nodes_.end()) return BrokenAnswer("there is no node ", split.id());
  if (static_cast<size_t>(split.children_size()) > nodes_.size()) {
    return BrokenAnswer("node ", split.id(), " has too many children");
  }
  SegmentNode& node = it->second;
  node.children.assign(split.children().begin(), split.children().end());
  node.iterations = split.iterations();
  node.stop_reason =
      node.children.empty() ? StopReasonName(split.stop_reason()) : "";
  return absl::OkStatus();
}

absl::StatusOr<Level*> AnswerBuilder::LevelOf(uint32_t level) {
  if (level == 0 || level > levels_.size()) {
    return BrokenAnswer("level ", level, " was not announced");
  }
  return &levels_[level - 1];
}

absl::Status AnswerBuilder::AddLabels(const v1::Labels& labels) {
  if (labels.level() == kCutLevel) return cut_.AddLabels(labels);
  MARROW_ASSIGN_OR_RETURN(Level * level, LevelOf(labels.level()));
  level_ended_ = true;
  return TakeLabels(labels, size_, *level);
}

absl::Status AnswerBuilder::AddSkeleton(const v1::Skeleton& skeleton) {
  if (skeleton.level() == kCutLevel) return cut_.AddJoints(skeleton);
  MARROW_ASSIGN_OR_RETURN(Level * level, LevelOf(skeleton.level()));
  level_ended_ = true;
  return TakeJoints(
      skeleton, size_, [this](uint32_t id) { return nodes_.contains(id); },
      *level);
}

absl::Status AnswerBuilder::AddCompleted(const v1::Completed& completed) {
  completed_ = true;
  timings_ = TimingsJson(completed.timings());
  cache_ = CacheJson(completed.spectrum());
  cache_["result"] = OutcomeName(completed.result());
  cache_["mesh_digest"] = HexOf(completed.mesh_digest().sha256());
  cache_["geometry_digest"] = HexOf(completed.geometry_digest().sha256());
  for (const v1::Split& split : completed.splits()) {
    MARROW_RETURN_IF_ERROR(AddSplit(split));
  }
  return absl::OkStatus();
}

absl::Status AnswerBuilder::CheckTree() const {
  size_t links = 0;
  for (const auto& [id, node] : nodes_) {
    if ((id == 0) != (node.parent == kNone))
      return BrokenAnswer("it has two roots");
    for (uint32_t child : node.children) {
      const auto it = nodes_.find(child);
      if (it == nodes_.end() || it->second.parent != id || child <= id) {
        return BrokenAnswer("node ", child, " is no child of ", id);
      }
    }
    if (std::adjacent_find(node.children.begin(), node.children.end(),
                           std::greater_equal<>()) != node.children.end()) {
      return BrokenAnswer("the children of node ", id, " are not ascending");
    }
    links += node.children.size();
  }
  if (!nodes_.contains(0) || links + 1 != nodes_.size()) {
    return BrokenAnswer("its nodes are no tree");
  }
  return absl::OkStatus();
}

absl::StatusOr<Segmentation> AnswerBuilder::Finish() {
  if (!completed_) return BrokenAnswer("it ends without its last event");
  if (levels_.empty()) return BrokenAnswer("it has no level");
  MARROW_RETURN_IF_ERROR(CheckTree());
  Segmentation result;
  for (const Level& level : levels_) {
    MARROW_RETURN_IF_ERROR(CheckLabels(
        level, size_, [this](uint32_t id) { return nodes_.contains(id); }));
  }
  if (cut_.begun()) {
    MARROW_ASSIGN_OR_RETURN(result.cut, cut_.Finish());
  }
  result.levels = std::move(levels_);
  for (auto& [id, node] : nodes_) result.nodes.push_back(std::move(node));
  report_["warnings"] = std::move(warnings_);
  result.report = std::move(report_);
  result.timings = std::move(timings_);
  result.cache = std::move(cache_);
  return result;
}

absl::StatusOr<CutAnswer> AnswerBuilder::FinishCut() {
  if (!completed_) return BrokenAnswer("it ends without its last event");
  CutAnswer result;
  MARROW_ASSIGN_OR_RETURN(result.cut, cut_.Finish());
  result.timings = std::move(timings_);
  result.cache = std::move(cache_);
  return result;
}

}  // namespace marrow::client
