#include "client/cut_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "client/answer_builder.h"
#include "core/base/crc32c.h"

namespace marrow::client {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr uint32_t kFaces = 4;
constexpr uint32_t kPoints = 3;

std::string Pack(const std::vector<uint32_t>& values) {
  std::string bytes;
  for (uint32_t value : values) {
    for (int b = 0; b < 4; ++b) bytes += static_cast<char>(value >> (8 * b));
  }
  return bytes;
}

v1::SegmentEvent LabelsEvent(v1::LabelDomain domain,
                             const std::vector<uint32_t>& values) {
  v1::SegmentEvent event;
  v1::Labels& labels = *event.mutable_labels();
  labels.set_domain(domain);
  labels.set_total_count(static_cast<uint32_t>(values.size()));
  labels.set_labels(Pack(values));
  labels.set_labels_crc32c(Crc32c(labels.labels()));
  return event;
}

// Segments 2, a node, and 7, which is none; 7's points come in two messages.
v1::SegmentEvent CutEvent() {
  v1::SegmentEvent event;
  v1::CutSegments& cut = *event.mutable_cut();
  cut.set_tree_nodes(5);
  cut.set_salience(0.25);
  for (uint32_t id : {2u, 7u}) {
    v1::Node& segment = *cut.add_segments();
    segment.set_id(id);
    segment.set_parent(1);
    segment.set_area(id);
    segment.set_medial_structure(Pack({0, 1}));
  }
  v1::Node& more = *cut.add_segments();
  more.set_id(7);
  more.set_medial_structure(Pack({2}));
  return event;
}

v1::SegmentEvent SkeletonEvent() {
  v1::SegmentEvent event;
  event.mutable_skeleton()->add_joints()->add_segments(7);
  v1::Joint& joint = *event.mutable_skeleton()->add_joints();
  joint.set_parent(0);
  joint.add_segments(2);
  return event;
}

// A good answer, in the order of events: what the tests spoil.
enum Position { kCutEvent, kFacesEvent, kPointsEvent, kSkeletonEvent };
std::vector<v1::SegmentEvent> GoodAnswer() {
  v1::SegmentEvent completed;
  completed.mutable_completed()->set_result(v1::CACHE_OUTCOME_HIT);
  return {CutEvent(), LabelsEvent(v1::LABEL_DOMAIN_FACE, {2, 7, 7, 2}),
          LabelsEvent(v1::LABEL_DOMAIN_VERTEX, {2, 7, kNone}), SkeletonEvent(),
          completed};
}

absl::StatusOr<CutAnswer> Build(std::vector<v1::SegmentEvent> events) {
  AnswerBuilder builder(kFaces, kPoints);
  uint64_t sequence = 0;
  for (v1::SegmentEvent& event : events) {
    event.set_sequence(++sequence);
    if (absl::Status status = builder.Add(event); !status.ok()) return status;
  }
  return builder.FinishCut();
}

TEST(CutBuilderTest, PutsACutTogether) {
  const absl::StatusOr<CutAnswer> answer = Build(GoodAnswer());
  ASSERT_TRUE(answer.ok()) << answer.status();
  const Cut& cut = answer->cut;
  ASSERT_EQ(cut.segments.size(), 2u);
  EXPECT_EQ(cut.segments[1].id, 7u);
  EXPECT_EQ(cut.segments[1].parent, 1u);
  EXPECT_EQ(cut.segments[1].area, 7);
  EXPECT_THAT(cut.segments[0].medial_structure, ElementsAre(0, 1));
  EXPECT_THAT(cut.segments[1].medial_structure, ElementsAre(0, 1, 2));
  EXPECT_EQ(cut.tree_nodes, 5u);
  EXPECT_EQ(cut.salience, 0.25);
  EXPECT_THAT(cut.level.face_labels, ElementsAre(2, 7, 7, 2));
  EXPECT_THAT(cut.level.vertex_labels, ElementsAre(2, 7, kNone));
  EXPECT_EQ(cut.level.skeleton.joints.size(), 2u);
  EXPECT_EQ(answer->cache["result"], "hit");
}

TEST(CutBuilderTest, TrustsNothing) {
  using Events = std::vector<v1::SegmentEvent>;
  const std::vector<std::pair<std::string, std::function<void(Events&)>>>
      cases = {
          {"lacks the cut", [](Events& e) { e = {e.back()}; }},
          {"without its last event", [](Events& e) { e.pop_back(); }},
          {"labels of a cut came before it",
           [](Events& e) { e.erase(e.begin()); }},
          {"skeleton of a cut came before it",
           [](Events& e) { e.erase(e.begin(), e.begin() + 3); }},
          {"the cut lacks labels",
           [](Events& e) { e.erase(e.begin() + kFacesEvent); }},
          {"the cut lacks labels",
           [](Events& e) { e.erase(e.begin() + kPointsEvent); }},
          {"label 3 is no node",
           [](Events& e) {
             e[kFacesEvent] = LabelsEvent(v1::LABEL_DOMAIN_FACE, {2, 7, 3, 2});
           }},
          {"came twice",
           [](Events& e) {
             e[kCutEvent].mutable_cut()->mutable_segments(2)->set_id(2);
           }},
          {"more segments than there are faces",
           [](Events& e) {
             for (uint32_t id = 10; id < 20; ++id) {
               e[kCutEvent].mutable_cut()->add_segments()->set_id(id);
             }
           }},
          {"has point 3 of 3",
           [](Events& e) {
             e[kCutEvent]
                 .mutable_cut()
                 ->mutable_segments(0)
                 ->set_medial_structure(Pack({3}));
           }},
          {"medial structure",
           [](Events& e) {
             for (int i = 0; i < 10; ++i)
               *e[kCutEvent].mutable_cut()->add_segments() =
                   e[kCutEvent].cut().segments(2);
           }},
          {"no node 3",
           [](Events& e) {
             e[kSkeletonEvent]
                 .mutable_skeleton()
                 ->mutable_joints(1)
                 ->set_segments(0, 3);
           }},
      };
  for (const auto& [what, spoil] : cases) {
    Events events = GoodAnswer();
    spoil(events);
    const absl::Status status = Build(events).status();
    EXPECT_TRUE(absl::IsDataLoss(status)) << what << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr(what));
  }
}

}  // namespace
}  // namespace marrow::client
