#include "server/event_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "core/base/crc32c.h"

namespace marrow {
namespace {

constexpr size_t kMaxMessageBytes = 1 << 20;

template <typename T>
std::vector<T> Unpack(const std::string& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

// n vertices and faces; two points a vertex, the second half unused by faces;
// two decoded faces a canonical one.
CanonicalMesh DoubledMesh(uint32_t n) {
  CanonicalMesh mesh;
  mesh.mesh.positions = Positions::Zero(n, 3);
  mesh.mesh.faces.resize(n);
  for (uint32_t i = 0; i < n; ++i) mesh.point_map.push_back(n - 1 - i);
  for (uint32_t i = 0; i < n; ++i) mesh.point_map.push_back(kNoIndex);
  for (uint32_t i = 0; i < 2 * n; ++i) mesh.face_map.push_back(i / 2);
  return mesh;
}

SegmentNode NodeOf(uint32_t id, uint32_t parent, uint32_t level,
                   std::vector<uint32_t> faces) {
  SegmentNode node;
  node.id = id;
  node.parent = parent;
  node.level = level;
  node.faces = std::move(faces);
  return node;
}

// The root; 1 and 2 below it; 3 and 4 below 1; 2 is a leaf.
SegmentTree SmallTree() {
  SegmentTree tree;
  tree.nodes = {NodeOf(0, kNoIndex, 0, {0, 1, 2}), NodeOf(1, 0, 1, {0, 1}),
                NodeOf(2, 0, 1, {2}), NodeOf(3, 1, 2, {0}),
                NodeOf(4, 1, 2, {1})};
  tree.nodes[0].children = {1, 2};
  tree.nodes[0].iterations = 7;
  tree.nodes[1].children = {3, 4};
  tree.nodes[2].stop_reason = StopReason::kTooSmall;
  tree.nodes[3].stop_reason = StopReason::kDepth;
  tree.nodes[4].stop_reason = StopReason::kDepth;
  return tree;
}

std::vector<uint32_t> NodeIds(const v1::Level& level) {
  std::vector<uint32_t> ids;
  for (const v1::Node& node : level.nodes()) ids.push_back(node.id());
  return ids;
}

template <typename Message>
std::vector<uint32_t> SplitIds(const Message& message) {
  std::vector<uint32_t> ids;
  for (const v1::Split& split : message.splits()) ids.push_back(split.id());
  return ids;
}

using Ids = std::vector<uint32_t>;

TEST(LevelEventsTest, EveryNodeAndSplitComesOnce) {
  const CanonicalMesh mesh = DoubledMesh(3);
  const SegmentTree tree = SmallTree();
  LevelEvents events(mesh);
  const auto first = events.OfLevel(tree, 1);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(NodeIds(first[0].level()), (Ids{0, 1, 2}));
  EXPECT_EQ(SplitIds(first[0].level()), (Ids{0}));
  EXPECT_EQ(first[0].level().splits(0).iterations(), 7u);
  EXPECT_FALSE(first[0].level().nodes(0).has_parent());
  EXPECT_EQ(first[0].level().nodes(1).parent(), 0u);
  EXPECT_EQ(first[0].level().nodes(1).face_count(), 4u);

  const auto second = events.OfLevel(tree, 2);
  EXPECT_EQ(NodeIds(second[0].level()), (Ids{3, 4}));
  EXPECT_EQ(SplitIds(second[0].level()), (Ids{1, 2}));
  EXPECT_EQ(second[0].level().splits(1).stop_reason(),
            v1::STOP_REASON_TOO_SMALL);
  v1::Completed completed;
  events.AddLastSplits(tree, &completed);
  EXPECT_EQ(SplitIds(completed), (Ids{3, 4}));
}

TEST(LevelEventsTest, ALevelBringsTheNodesOfThoseLeftOut) {
  const CanonicalMesh mesh = DoubledMesh(3);
  LevelEvents events(mesh);
  const auto second = events.OfLevel(SmallTree(), 2);
  EXPECT_EQ(NodeIds(second[0].level()), (Ids{0, 1, 2, 3, 4}));
  EXPECT_EQ(SplitIds(second[0].level()), (Ids{0, 1, 2}));
}

TEST(LevelEventsTest, AHugeMedialStructureIsSpread) {
  constexpr uint32_t kVertices = 1'000'000;
  const CanonicalMesh mesh = DoubledMesh(kVertices);
  SegmentTree tree;
  tree.nodes = {NodeOf(0, kNoIndex, 0, {})};
  for (uint32_t v = 0; v < kVertices; ++v) {
    tree.nodes[0].medial_structure.push_back(v);
    tree.nodes[0].faces.push_back(v);
  }
  LevelEvents events(mesh);
  Ids points;
  for (const v1::SegmentEvent& event : events.OfLevel(tree, 1)) {
    EXPECT_LT(event.ByteSizeLong(), kMaxMessageBytes);
    EXPECT_EQ(event.level().level(), 1u);
    for (const v1::Node& node : event.level().nodes()) {
      EXPECT_EQ(node.id(), 0u);
      for (uint32_t p : Unpack<uint32_t>(node.medial_structure())) {
        points.push_back(p);
      }
    }
  }
  ASSERT_EQ(points.size(), kVertices);
  for (uint32_t p = 0; p < kVertices; ++p) ASSERT_EQ(points[p], p);
}

TEST(LabelEventsTest, ChunksCoverTheLabelsInOrder) {
  std::vector<uint32_t> labels(200'000);
  for (size_t i = 0; i < labels.size(); ++i) labels[i] = i * 3;
  std::vector<uint32_t> joined;
  for (const auto& event : LabelEvents(2, v1::LABEL_DOMAIN_FACE, labels)) {
    const v1::Labels& chunk = event.labels();
    EXPECT_EQ(chunk.level(), 2u);
    EXPECT_EQ(chunk.total_count(), 200'000u);
    EXPECT_EQ(chunk.first_index(), joined.size());
    EXPECT_LE(chunk.labels().size(), 256u << 10);
    EXPECT_EQ(chunk.labels_crc32c(), Crc32c(chunk.labels()));
    for (uint32_t label : Unpack<uint32_t>(chunk.labels())) {
      joined.push_back(label);
    }
  }
  EXPECT_EQ(joined, labels);
}

TEST(SkeletonEventsTest, AHugeSkeletonIsSpread) {
  Skeleton skeleton;
  for (uint32_t i = 0; i < 100'000; ++i) {
    Joint joint;
    joint.parent = i == 0 ? kNoIndex : i - 1;
    joint.articulation = i % 2 == 1;
    joint.segments = {i};
    skeleton.joints.push_back(joint);
  }
  uint32_t next = 0;
  for (const v1::SegmentEvent& event : SkeletonEvents(1, skeleton)) {
    EXPECT_LT(event.ByteSizeLong(), kMaxMessageBytes);
    for (const v1::Joint& joint : event.skeleton().joints()) {
      EXPECT_EQ(joint.has_parent(), next > 0);
      EXPECT_EQ(joint.segments(0), next);
      EXPECT_EQ(joint.kind(), next % 2 == 1 ? v1::JOINT_KIND_ARTICULATION
                                            : v1::JOINT_KIND_SEGMENT);
      ++next;
    }
  }
  EXPECT_EQ(next, 100'000u);
}

TEST(SkeletonEventsTest, AnEmptySkeletonIsOneEvent) {
  EXPECT_EQ(SkeletonEvents(1, Skeleton()).size(), 1u);
}

TEST(SpectrumEventsTest, EigenvectorsComeInTheCallersUnitsAndOrder) {
  constexpr uint32_t kVertices = 50'000;
  auto mesh = std::make_shared<CanonicalMesh>(DoubledMesh(kVertices));
  auto spectrum = std::make_shared<CertifiedSpectrum>();
  spectrum->area = 4;
  spectrum->eigenvalues = Eigen::Vector2d(0, 8);
  spectrum->residuals = Eigen::Vector2d(0, 1e-9);
  spectrum->bound = 10;
  spectrum->count_below_bound = 2;
  spectrum->eigenvectors.setZero(kVertices, 2);
  for (uint32_t v = 0; v < kVertices; ++v) spectrum->eigenvectors(v, 1) = v;
  const SpectrumEvents events(mesh, spectrum, true);
  EXPECT_EQ(events.Make(0).header().pair_count(), 2u);
  EXPECT_EQ(events.Make(0).header().point_count(), 2 * kVertices);
  EXPECT_EQ(events.Make(1).eigenvalues().eigenvalues(1), 2.0);
  const v1::SpectrumCertificate certificate = events.Make(2).certificate();
  EXPECT_EQ(certificate.residuals(1), 1e-9);
  EXPECT_EQ(certificate.bound(), 2.5);
  EXPECT_EQ(certificate.count_below_bound(), 2u);
  std::vector<double> second;
  for (uint64_t i = 3; i < events.count(); ++i) {
    const auto event = events.Make(i);
    const v1::EigenvectorChunk& chunk = event.eigenvector_chunk();
    EXPECT_EQ(chunk.values_crc32c(), Crc32c(chunk.values()));
    EXPECT_LE(chunk.values().size(), 256u << 10);
    if (chunk.pair() != 1) continue;
    EXPECT_EQ(chunk.first_point(), second.size());
    for (double x : Unpack<double>(chunk.values())) second.push_back(x);
  }
  ASSERT_EQ(second.size(), 2 * kVertices);
  EXPECT_EQ(second[0], (kVertices - 1) / 2.0);
  EXPECT_EQ(second[kVertices - 1], 0.0);
  EXPECT_TRUE(std::isnan(second[kVertices]));
}

TEST(SpectrumEventsTest, ACertificateWithoutEigenvectors) {
  auto spectrum = std::make_shared<CertifiedSpectrum>();
  spectrum->area = 1;
  spectrum->eigenvalues = spectrum->residuals = Eigen::Vector2d(0, 8);
  const SpectrumEvents events(std::make_shared<CanonicalMesh>(DoubledMesh(3)),
                              spectrum, false);
  ASSERT_EQ(events.count(), 3u);
  EXPECT_TRUE(events.Make(2).has_certificate());
}

TEST(SpectrumEventsTest, EigenvaluesAlone) {
  auto pairs = std::make_shared<EigenPairs>();
  pairs->area = 1;
  pairs->eigenvalues = Eigen::Vector2d(0, 8);
  const SpectrumEvents events(std::make_shared<CanonicalMesh>(DoubledMesh(3)),
                              pairs);
  EXPECT_EQ(events.count(), 2u);
}

}  // namespace
}  // namespace marrow
