#include "client/answer_parts.h"

#include <string>
#include <utility>
#include <vector>

#include "core/base/crc32c.h"

namespace marrow::client {
namespace {

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

std::string NameOf(const Level& level) {
  return level.level == 0 ? "the cut" : absl::StrCat("level ", level.level);
}

}  // namespace

SegmentNode ToSegmentNode(const v1::Node& node) {
  SegmentNode result;
  result.id = node.id();
  result.parent = node.has_parent() ? node.parent() : kNone;
  result.level = node.level();
  result.area = node.area();
  result.salience = node.salience();
  result.centroid = ToPoint(node.centroid());
  return result;
}

absl::Status TakeMedialPoints(const v1::Node& node, const PayloadSize& size,
                              size_t& budget, SegmentNode& result) {
  const std::string& medial = node.medial_structure();
  if (medial.size() % sizeof(uint32_t) != 0 ||
      medial.size() / sizeof(uint32_t) > budget) {
    return BrokenAnswer("the medial structure of node ", node.id(), " has ",
                        medial.size(), " bytes");
  }
  for (uint32_t point : UnpackUint32(medial)) {
    if (point >= size.num_points) {
      return BrokenAnswer("node ", node.id(), " has point ", point, " of ",
                          size.num_points);
    }
    result.medial_structure.push_back(point);
    --budget;
  }
  return absl::OkStatus();
}

absl::Status TakeLabels(const v1::Labels& labels, const PayloadSize& size,
                        Level& level) {
  const bool faces = labels.domain() == v1::LABEL_DOMAIN_FACE;
  if (!faces && labels.domain() != v1::LABEL_DOMAIN_VERTEX) {
    return absl::OkStatus();  // a domain of later servers
  }
  const uint32_t expected = faces ? size.num_faces : size.num_points;
  std::vector<uint32_t>& known =
      faces ? level.face_labels : level.vertex_labels;
  const std::string& bytes = labels.labels();
  if (labels.total_count() != expected) {
    return BrokenAnswer("it has ", labels.total_count(), " labels for ",
                        expected, faces ? " faces" : " points");
  }
  if (labels.first_index() != known.size() ||
      bytes.size() % sizeof(uint32_t) != 0 ||
      bytes.size() / sizeof(uint32_t) > expected - known.size()) {
    return BrokenAnswer("a chunk of labels does not fit at ",
                        labels.first_index());
  }
  if (Crc32c(bytes) != labels.labels_crc32c()) {
    return BrokenAnswer("the checksum of a chunk of labels does not match");
  }
  const std::vector<uint32_t> values = UnpackUint32(bytes);
  known.insert(known.end(), values.begin(), values.end());
  return absl::OkStatus();
}

absl::Status TakeJoints(const v1::Skeleton& skeleton, const PayloadSize& size,
                        const KnownId& is_known, Level& level) {
  std::vector<Joint>& joints = level.skeleton.joints;
  for (const v1::Joint& joint : skeleton.joints()) {
    // A tree over at most as many segments as faces, a joint on every link.
    if (joints.size() >= size_t{2} * size.num_faces ||
        joint.segments_size() > 2) {
      return BrokenAnswer("a skeleton is larger than its mesh");
    }
    Joint result;
    result.id = static_cast<uint32_t>(joints.size());
    result.parent = joint.has_parent() ? joint.parent() : kNone;
    if (joint.has_parent() ? result.parent >= result.id : result.id != 0) {
      return BrokenAnswer("joint ", result.id, " has no parent before it");
    }
    result.articulation = joint.kind() == v1::JOINT_KIND_ARTICULATION;
    result.position = ToPoint(joint.position());
    result.segments.assign(joint.segments().begin(), joint.segments().end());
    for (uint32_t segment : result.segments) {
      if (!is_known(segment)) return BrokenAnswer("no node ", segment);
    }
    joints.push_back(std::move(result));
  }
  return absl::OkStatus();
}

absl::Status CheckLabels(const Level& level, const PayloadSize& size,
                         const KnownId& is_known) {
  if (level.face_labels.size() != size.num_faces ||
      level.vertex_labels.size() != size.num_points) {
    return BrokenAnswer(NameOf(level), " lacks labels");
  }
  for (uint32_t label : level.face_labels) {
    if (!is_known(label)) return BrokenAnswer("label ", label, " is no node");
  }
  for (uint32_t label : level.vertex_labels) {
    if (label != kNone && !is_known(label)) {
      return BrokenAnswer("label ", label, " is no node");
    }
  }
  return absl::OkStatus();
}

}  // namespace marrow::client
