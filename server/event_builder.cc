#include "server/event_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "core/base/crc32c.h"
#include "server/mesh_warnings.h"
#include "server/prediction.h"

namespace marrow {
namespace {

// Labels and eigenvectors go out as they lie in memory.
static_assert(std::endian::native == std::endian::little);

constexpr uint64_t kValuesAChunk = kChunkBytes / sizeof(double);

template <typename T>
void SetPacked(const T* values, size_t count, std::string* bytes) {
  bytes->assign(reinterpret_cast<const char*>(values), count * sizeof(T));
}

void SetVector(const Eigen::Vector3d& v, v1::Vector3* message) {
  message->set_x(v.x());
  message->set_y(v.y());
  message->set_z(v.z());
}

std::string DigestBytes(const Digest& digest) {
  return std::string(digest.bytes.begin(), digest.bytes.end());
}

v1::StopReason ToStopReason(StopReason reason) {
  switch (reason) {
    case StopReason::kNone:
      return v1::STOP_REASON_UNSPECIFIED;
    case StopReason::kOneSegment:
      return v1::STOP_REASON_ONE_SEGMENT;
    case StopReason::kTooSmall:
      return v1::STOP_REASON_TOO_SMALL;
    case StopReason::kTooFewEigenPairs:
      return v1::STOP_REASON_TOO_FEW_EIGEN_PAIRS;
    case StopReason::kDepth:
      return v1::STOP_REASON_DEPTH;
  }
  return v1::STOP_REASON_UNSPECIFIED;
}

v1::CacheOutcome ToOutcome(CacheOutcome outcome) {
  switch (outcome) {
    case CacheOutcome::kHit:
      return v1::CACHE_OUTCOME_HIT;
    case CacheOutcome::kMiss:
      return v1::CACHE_OUTCOME_MISS;
    case CacheOutcome::kJoined:
      return v1::CACHE_OUTCOME_JOINED;
  }
  return v1::CACHE_OUTCOME_UNSPECIFIED;
}

void SetSplit(const SegmentNode& node, v1::Split* split) {
  split->set_id(node.id);
  split->mutable_children()->Add(node.children.begin(), node.children.end());
  split->set_iterations(node.iterations);
  split->set_stop_reason(ToStopReason(node.stop_reason));
}

// Spreads the items of a message over as many messages as their size asks
// for.
template <typename Part>
class Spreader {
 public:
  // `begin` fills what every message has.
  Spreader(Part* (v1::SegmentEvent::*part)(), std::function<void(Part*)> begin)
      : part_(part), begin_(std::move(begin)) {
    Open();
  }

  // The message that an item of so many bytes goes to.
  Part* For(size_t bytes) {
    if (bytes_ > 0 && bytes_ + bytes > kChunkBytes) Open();
    bytes_ += bytes;
    return (events_.back().*part_)();
  }

  std::vector<v1::SegmentEvent> Take() { return std::move(events_); }

 private:
  void Open() {
    bytes_ = 0;
    begin_((events_.emplace_back().*part_)());
  }

  Part* (v1::SegmentEvent::*const part_)();
  const std::function<void(Part*)> begin_;
  size_t bytes_ = 0;
  std::vector<v1::SegmentEvent> events_;
};

v1::Joint ToJoint(const Joint& joint) {
  v1::Joint message;
  if (joint.parent != kNoIndex) message.set_parent(joint.parent);
  message.set_kind(joint.articulation ? v1::JOINT_KIND_ARTICULATION
                                      : v1::JOINT_KIND_SEGMENT);
  SetVector(joint.position, message.mutable_position());
  message.mutable_segments()->Add(joint.segments.begin(), joint.segments.end());
  return message;
}

std::vector<uint32_t> CountDecodedFaces(const CanonicalMesh& mesh) {
  std::vector<uint32_t> counts(mesh.mesh.NumFaces(), 0);
  for (const uint32_t face : mesh.face_map) ++counts[face];
  return counts;
}

// More than one where the medial structure is larger than a chunk. Of a node of
// the tree and of a cut's segment.
template <typename Segment>
std::vector<v1::Node> ToNodes(const Segment& segment, uint32_t face_count,
                              const std::vector<uint32_t>& point_of_vertex) {
  v1::Node first;
  first.set_id(segment.id);
  if (segment.parent != kNoIndex) first.set_parent(segment.parent);
  first.set_level(segment.level);
  first.set_area(segment.area);
  SetVector(segment.centroid, first.mutable_centroid());
  first.set_face_count(face_count);
  first.set_salience(segment.salience);

  std::vector<uint32_t> points;
  points.reserve(segment.medial_structure.size());
  for (const uint32_t v : segment.medial_structure) {
    points.push_back(point_of_vertex[v]);
  }
  std::sort(points.begin(), points.end());

  std::vector<v1::Node> parts{std::move(first)};
  constexpr size_t kPointsAPart = kChunkBytes / 2 / sizeof(uint32_t);
  for (size_t i = 0; i < points.size(); i += kPointsAPart) {
    if (i > 0) parts.emplace_back().set_id(segment.id);
    SetPacked(&points[i], std::min(kPointsAPart, points.size() - i),
              parts.back().mutable_medial_structure());
  }
  return parts;
}

}  // namespace

void SetMeshDigest(const MeshDigest& digest, v1::MeshDigest* message) {
  message->set_sha256(DigestBytes(digest.sha256));
  message->set_size_bytes(digest.size_bytes);
}

void SetGeometryDigest(const Digest& digest, v1::GeometryDigest* message) {
  message->set_sha256(DigestBytes(digest));
}

void SetMeshReport(const MeshReport& report, v1::MeshReport* message) {
  message->set_decoded_points(report.decoded_points);
  message->set_decoded_faces(report.decoded_faces);
  message->set_vertices(report.vertices);
  message->set_faces(report.faces);
  message->set_welded_points(report.welded_points);
  message->set_crack_points(report.crack_points);
  message->set_t_junctions(report.t_junctions);
  message->set_unused_points(report.unused_points);
  message->set_degenerate_faces(report.degenerate_faces);
  message->set_duplicate_faces(report.duplicate_faces);
  message->set_inner_wall_faces(report.inner_wall_faces);
  message->set_zero_area_faces(report.zero_area_faces);
  message->set_components(report.components);
  message->set_boundary_edges(report.boundary_edges);
  message->set_boundary_loops(report.boundary_loops);
  message->set_nonmanifold_edges(report.nonmanifold_edges);
  message->set_nonmanifold_vertices(report.nonmanifold_vertices);
  message->set_euler_characteristic(report.euler_characteristic);
  message->set_area(report.area);
  SetVector(report.box_min, message->mutable_box_min());
  SetVector(report.box_max, message->mutable_box_max());
  message->set_sliver_faces(report.sliver_faces);
  message->set_flipped_faces(report.flipped_faces);
  if (report.genus.has_value()) message->set_genus(*report.genus);
  message->set_bodies(report.bodies);
  message->set_bridged_components(report.bridged_components);
  message->set_bridges(report.bridges);
  message->set_bridging_distance(report.bridging_distance);
  message->set_attached_components(report.attached_components);
  message->set_attached_faces(report.attached_faces);
  message->set_worn_components(report.worn_components);
  message->set_coarse_vertices(report.coarse_vertices);
  for (v1::Finding& finding : FindingsAbout(report)) {
    *message->add_findings() = std::move(finding);
  }
}

void SetPrediction(const MeshReport& report, uint32_t eigen_pairs,
                   v1::MeshReport* message) {
  const Prediction prediction = PredictSegmentation(report, eigen_pairs);
  message->set_predicted_seconds(prediction.seconds);
  message->set_predicted_bytes(prediction.bytes);
}

void SetSpectrumUse(const SpectrumUse& use, v1::SpectrumUse* message) {
  message->set_outcome(ToOutcome(use.outcome));
  message->set_solver_runs(use.solver_runs);
  message->set_eigen_pairs(use.eigen_pairs);
  message->set_edge_flips(static_cast<uint32_t>(use.laplacian.flips));
  message->set_mollification(use.laplacian.mollification);
}

v1::Stage ToStage(Stage stage) {
  switch (stage) {
    case Stage::kMesh:
      return v1::STAGE_MESH;
    case Stage::kSpectrum:
      return v1::STAGE_SPECTRUM;
    case Stage::kSegments:
      return v1::STAGE_SEGMENTS;
  }
  return v1::STAGE_UNSPECIFIED;
}

LevelEvents::LevelEvents(const CanonicalMesh& mesh)
    : point_of_vertex_(PointOfVertex(mesh)),
      decoded_faces_(CountDecodedFaces(mesh)) {}

std::vector<v1::Node> LevelEvents::ToNodes(const SegmentNode& node) const {
  uint32_t faces = 0;
  for (const uint32_t face : node.faces) faces += decoded_faces_[face];
  return marrow::ToNodes(node, faces, point_of_vertex_);
}

std::vector<v1::SegmentEvent> LevelEvents::OfLevel(const SegmentTree& tree,
                                                   uint32_t level) {
  Spreader<v1::Level> spreader(
      &v1::SegmentEvent::mutable_level,
      [level](v1::Level* message) { message->set_level(level); });
  for (; nodes_sent_ < tree.nodes.size() &&
         tree.nodes[nodes_sent_].level <= level;
       ++nodes_sent_) {
    without_split_.insert(static_cast<uint32_t>(nodes_sent_));
    for (v1::Node& node : ToNodes(tree.nodes[nodes_sent_])) {
      const size_t bytes = node.ByteSizeLong();
      *spreader.For(bytes)->add_nodes() = std::move(node);
    }
  }
  // The splits of this level's own nodes are not known yet.
  while (!without_split_.empty() &&
         tree.nodes[*without_split_.begin()].level < level) {
    v1::Split split;
    SetSplit(tree.nodes[*without_split_.begin()], &split);
    without_split_.erase(without_split_.begin());
    const size_t bytes = split.ByteSizeLong();
    *spreader.For(bytes)->add_splits() = std::move(split);
  }
  for (const uint32_t segment : tree.SegmentsAtLevel(level)) {
    spreader.For(sizeof(uint32_t) + 1)->add_segments(segment);
  }
  return spreader.Take();
}

void LevelEvents::AddLastSplits(const SegmentTree& tree,
                                v1::Completed* completed) const {
  for (const uint32_t id : without_split_) {
    SetSplit(tree.nodes[id], completed->add_splits());
  }
}

std::vector<v1::SegmentEvent> LabelEvents(uint32_t level,
                                          v1::LabelDomain domain,
                                          const std::vector<uint32_t>& labels) {
  constexpr size_t kLabelsAChunk = kChunkBytes / sizeof(uint32_t);
  std::vector<v1::SegmentEvent> events;
  for (size_t i = 0; i < labels.size(); i += kLabelsAChunk) {
    v1::Labels* message = events.emplace_back().mutable_labels();
    message->set_level(level);
    message->set_domain(domain);
    message->set_total_count(static_cast<uint32_t>(labels.size()));
    message->set_first_index(static_cast<uint32_t>(i));
    SetPacked(&labels[i], std::min(kLabelsAChunk, labels.size() - i),
              message->mutable_labels());
    message->set_labels_crc32c(Crc32c(message->labels()));
  }
  return events;
}

std::vector<v1::SegmentEvent> SkeletonEvents(uint32_t level,
                                             const Skeleton& skeleton) {
  Spreader<v1::Skeleton> spreader(
      &v1::SegmentEvent::mutable_skeleton,
      [level](v1::Skeleton* message) { message->set_level(level); });
  for (const Joint& joint : skeleton.joints) {
    v1::Joint message = ToJoint(joint);
    const size_t bytes = message.ByteSizeLong();
    *spreader.For(bytes)->add_joints() = std::move(message);
  }
  return spreader.Take();
}

std::vector<v1::SegmentEvent> CutEvents(const SegmentedMesh& mesh,
                                        const CutResult& cut) {
  Spreader<v1::CutSegments> spreader(
      &v1::SegmentEvent::mutable_cut, [&](v1::CutSegments* message) {
        message->set_tree_nodes(
            static_cast<uint32_t>(mesh.tree().nodes.size()));
        message->set_salience(cut.salience);
      });
  const std::vector<uint32_t> point_of_vertex = PointOfVertex(mesh.canonical());
  for (const CutResult::Segment& segment : cut.segments) {
    for (v1::Node& node :
         ToNodes(segment, segment.decoded_faces, point_of_vertex)) {
      const size_t bytes = node.ByteSizeLong();
      *spreader.For(bytes)->add_segments() = std::move(node);
    }
  }
  return spreader.Take();
}

SpectrumEvents::SpectrumEvents(std::shared_ptr<const CanonicalMesh> mesh,
                               const std::shared_ptr<const EigenPairs>& pairs)
    : mesh_(std::move(mesh)),
      eigenvalues_(pairs->eigenvalues),
      area_(pairs->area) {}

SpectrumEvents::SpectrumEvents(
    std::shared_ptr<const CanonicalMesh> mesh,
    std::shared_ptr<const CertifiedSpectrum> spectrum, bool eigenvectors)
    : mesh_(std::move(mesh)),
      eigenvalues_(spectrum->eigenvalues),
      area_(spectrum->area),
      certified_(std::move(spectrum)) {
  if (!eigenvectors) return;
  pairs_sent_ = certified_->NumPairs();
  chunks_a_pair_ =
      (mesh_->point_map.size() + kValuesAChunk - 1) / kValuesAChunk;
}

v1::SpectrumEvent SpectrumEvents::Make(uint64_t index) const {
  if (index == 0) return Header();
  if (index == 1) return Eigenvalues();
  if (index == kBeforeCertificate) return Certificate();
  const uint64_t chunk = index - kBeforeCertificate - 1;
  return Chunk(static_cast<uint32_t>(chunk / chunks_a_pair_),
               chunk % chunks_a_pair_ * kValuesAChunk);
}

v1::SpectrumEvent SpectrumEvents::Header() const {
  v1::SpectrumEvent event;
  v1::SpectrumHeader* header = event.mutable_header();
  header->set_pair_count(static_cast<uint32_t>(eigenvalues_.size()));
  header->set_point_count(static_cast<uint32_t>(mesh_->point_map.size()));
  SetMeshReport(mesh_->report, header->mutable_report());
  return event;
}

v1::SpectrumEvent SpectrumEvents::Eigenvalues() const {
  v1::SpectrumEvent event;
  for (const double lambda : eigenvalues_) {
    event.mutable_eigenvalues()->add_eigenvalues(lambda / area_);
  }
  return event;
}

v1::SpectrumEvent SpectrumEvents::Certificate() const {
  v1::SpectrumEvent event;
  v1::SpectrumCertificate* certificate = event.mutable_certificate();
  certificate->mutable_residuals()->Add(certified_->residuals.begin(),
                                        certified_->residuals.end());
  certificate->set_bound(certified_->bound / area_);
  certificate->set_count_below_bound(certified_->count_below_bound);
  return event;
}

v1::SpectrumEvent SpectrumEvents::Chunk(uint32_t pair,
                                        uint64_t first_point) const {
  const double scale = 1 / std::sqrt(area_);
  const size_t end = std::min(first_point + kValuesAChunk,
                              static_cast<uint64_t>(mesh_->point_map.size()));
  std::vector<double> values;
  values.reserve(end - first_point);
  for (size_t point = first_point; point < end; ++point) {
    const uint32_t v = mesh_->point_map[point];
    values.push_back(v == kNoIndex ? std::numeric_limits<double>::quiet_NaN()
                                   : scale * certified_->eigenvectors(v, pair));
  }
  v1::SpectrumEvent event;
  v1::EigenvectorChunk* chunk = event.mutable_eigenvector_chunk();
  chunk->set_pair(pair);
  chunk->set_first_point(static_cast<uint32_t>(first_point));
  SetPacked(values.data(), values.size(), chunk->mutable_values());
  chunk->set_values_crc32c(Crc32c(chunk->values()));
  return event;
}

}  // namespace marrow
