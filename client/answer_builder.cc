#include "client/answer_builder.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/message_json.h"
#include "core/base/crc32c.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

// Deeper than any server may go (levels: 1 to 8), so that a later server's
// wider range still fits.
constexpr uint32_t kMaxLevels = 64;

template <typename... Args>
absl::Status Bad(const Args&... args) {
  return absl::DataLossError(
      absl::StrCat("the server's answer is broken: ", args...));
}

std::vector<uint32_t> UnpackUint32(const std::string& bytes) {
  std::vector<uint32_t> values(bytes.size() / sizeof(uint32_t));
  for (size_t i = 0; i < values.size(); ++i) {
    uint32_t value = 0;
    for (size_t b = 0; b < sizeof(uint32_t); ++b) {
      value |= uint32_t{static_cast<unsigned char>(bytes[4 * i + b])}
               << (8 * b);
    }
    values[i] = value;
  }
  return values;
}

Point3 ToPoint(const v1::Vector3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

AnswerBuilder::AnswerBuilder(uint32_t num_faces, uint32_t num_points)
    : num_faces_(num_faces), num_points_(num_points) {}

absl::Status AnswerBuilder::Add(const v1::SegmentEvent& event) {
  if (event.sequence() != ++sequence_) {
    return Bad("event ", event.sequence(), " came in place of ", sequence_);
  }
  if (completed_) return Bad("an event came after the last");
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
    case v1::SegmentEvent::kWarning:
      if (warnings_.size() < num_faces_) {
        warnings_.push_back({{"code", event.warning().code()},
                             {"message", event.warning().message()}});
      }
      return absl::OkStatus();
    case v1::SegmentEvent::kCompleted:
      return AddCompleted(event.completed());
    default:  // accepted, progress, and what later servers may add
      return absl::OkStatus();
  }
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
    return Bad("level ", level, " came after ", levels_.size());
  }
  levels_.emplace_back().level = level;
  level_ended_ = false;
  last_node_ = kNone;
  // A vertex lies in at most as many segments as it has faces, and with level
  // 1 the root comes too.
  medial_budget_ = size_t{6} * num_faces_;
  return absl::OkStatus();
}

absl::Status AnswerBuilder::AddNode(const v1::Node& node) {
  if (node.id() != last_node_ || node.has_parent()) {
    MARROW_RETURN_IF_ERROR(BeginNode(node));
  }
  const std::string& medial = node.medial_structure();
  if (medial.size() % sizeof(uint32_t) != 0 ||
      medial.size() / sizeof(uint32_t) > medial_budget_) {
    return Bad("the medial structure of node ", node.id(), " has ",
               medial.size(), " bytes");
  }
  std::vector<uint32_t>& points = nodes_[node.id()].medial_structure;
  for (uint32_t point : UnpackUint32(medial)) {
    if (point >= num_points_) {
      return Bad("node ", node.id(), " has point ", point, " of ", num_points_);
    }
    points.push_back(point);
    --medial_budget_;
  }
  return absl::OkStatus();
}

absl::Status AnswerBuilder::BeginNode(const v1::Node& node) {
  // The nodes of a level share out the faces, so a level over m faces has at
  // most m, and the root comes before the first.
  if (nodes_.size() > levels_.size() * num_faces_) return Bad("too many nodes");
  SegmentNode result;
  result.id = node.id();
  result.parent = node.has_parent() ? node.parent() : kNone;
  result.level = node.level();
  result.area = node.area();
  result.salience = node.salience();
  result.centroid = ToPoint(node.centroid());
  if (!nodes_.emplace(node.id(), std::move(result)).second) {
    return Bad("node ", node.id(), " came twice");
  }
  last_node_ = node.id();
  return absl::OkStatus();
}

absl::Status AnswerBuilder::AddSplit(const v1::Split& split) {
  const auto it = nodes_.find(split.id());
  if (it == nodes_.end()) return Bad("there is no node ", split.id());
  if (static_cast<size_t>(split.children_size()) > nodes_.size()) {
    return Bad("node ", split.id(), " has too many children");
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
    return Bad("level ", level, " was not announced");
  }
  return &levels_[level - 1];
}

absl::Status AnswerBuilder::AddLabels(const v1::Labels& labels) {
  MARROW_ASSIGN_OR_RETURN(Level * level, LevelOf(labels.level()));
  level_ended_ = true;
  const bool faces = labels.domain() == v1::LABEL_DOMAIN_FACE;
  if (!faces && labels.domain() != v1::LABEL_DOMAIN_VERTEX) {
    return absl::OkStatus();  // a domain of later servers
  }
  const uint32_t expected = faces ? num_faces_ : num_points_;
  std::vector<uint32_t>& known =
      faces ? level->face_labels : level->vertex_labels;
  const std::string& bytes = labels.labels();
  if (labels.total_count() != expected) {
    return Bad("it has ", labels.total_count(), " labels for ", expected,
               faces ? " faces" : " points");
  }
  if (labels.first_index() != known.size() ||
      bytes.size() % sizeof(uint32_t) != 0 ||
      bytes.size() / sizeof(uint32_t) > expected - known.size()) {
    return Bad("a chunk of labels does not fit at ", labels.first_index());
  }
  if (Crc32c(bytes) != labels.labels_crc32c()) {
    return Bad("the checksum of a chunk of labels does not match");
  }
  const std::vector<uint32_t> values = UnpackUint32(bytes);
  known.insert(known.end(), values.begin(), values.end());
  return absl::OkStatus();
}

absl::Status AnswerBuilder::AddSkeleton(const v1::Skeleton& skeleton) {
  MARROW_ASSIGN_OR_RETURN(Level * level, LevelOf(skeleton.level()));
  level_ended_ = true;
  std::vector<Joint>& joints = level->skeleton.joints;
  for (const v1::Joint& joint : skeleton.joints()) {
    // A tree over at most as many segments as faces, a joint on every link.
    if (joints.size() >= size_t{2} * num_faces_ || joint.segments_size() > 2) {
      return Bad("a skeleton is larger than its mesh");
    }
    Joint result;
    result.id = static_cast<uint32_t>(joints.size());
    result.parent = joint.has_parent() ? joint.parent() : kNone;
    if (joint.has_parent() ? result.parent >= result.id : result.id != 0) {
      return Bad("joint ", result.id, " has no parent before it");
    }
    result.articulation = joint.kind() == v1::JOINT_KIND_ARTICULATION;
    result.position = ToPoint(joint.position());
    result.segments.assign(joint.segments().begin(), joint.segments().end());
    for (uint32_t segment : result.segments) {
      if (!nodes_.contains(segment)) return Bad("no node ", segment);
    }
    joints.push_back(std::move(result));
  }
  return absl::OkStatus();
}

absl::Status AnswerBuilder::AddCompleted(const v1::Completed& completed) {
  completed_ = true;
  timings_ = TimingsJson(completed.timings());
  cache_ = CacheJson(completed.spectrum());
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
    if ((id == 0) != (node.parent == kNone)) return Bad("it has two roots");
    for (uint32_t child : node.children) {
      const auto it = nodes_.find(child);
      if (it == nodes_.end() || it->second.parent != id || child <= id) {
        return Bad("node ", child, " is no child of ", id);
      }
    }
    if (std::adjacent_find(node.children.begin(), node.children.end(),
                           std::greater_equal<>()) != node.children.end()) {
      return Bad("the children of node ", id, " are not ascending");
    }
    links += node.children.size();
  }
  if (!nodes_.contains(0) || links + 1 != nodes_.size()) {
    return Bad("its nodes are no tree");
  }
  return absl::OkStatus();
}

absl::Status AnswerBuilder::CheckLevel(const Level& level) const {
  if (level.face_labels.size() != num_faces_ ||
      level.vertex_labels.size() != num_points_) {
    return Bad("level ", level.level, " lacks labels");
  }
  for (uint32_t label : level.face_labels) {
    if (!nodes_.contains(label)) return Bad("label ", label, " is no node");
  }
  for (uint32_t label : level.vertex_labels) {
    if (label != kNone && !nodes_.contains(label)) {
      return Bad("label ", label, " is no node");
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<Segmentation> AnswerBuilder::Finish() {
  if (!completed_) return Bad("it ends without its last event");
  if (levels_.empty()) return Bad("it has no level");
  MARROW_RETURN_IF_ERROR(CheckTree());
  Segmentation result;
  for (const Level& level : levels_) {
    MARROW_RETURN_IF_ERROR(CheckLevel(level));
  }
  result.levels = std::move(levels_);
  for (auto& [id, node] : nodes_) result.nodes.push_back(std::move(node));
  report_["warnings"] = std::move(warnings_);
  result.report = std::move(report_);
  result.timings = std::move(timings_);
  result.cache = std::move(cache_);
  return result;
}

}  // namespace marrow::client
