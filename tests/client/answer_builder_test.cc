#include "client/answer_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/base/crc32c.h"

namespace marrow::client {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr uint32_t kFaces = 4;
constexpr uint32_t kPoints = 5;

std::string Pack(const std::vector<uint32_t>& values) {
  std::string bytes;
  for (uint32_t value : values) {
    for (int b = 0; b < 4; ++b) bytes += static_cast<char>(value >> (8 * b));
  }
  return bytes;
}

v1::SegmentEvent LabelsEvent(v1::LabelDomain domain, uint32_t total,
                             uint32_t first,
                             const std::vector<uint32_t>& values) {
  v1::SegmentEvent event;
  v1::Labels& labels = *event.mutable_labels();
  labels.set_level(1);
  labels.set_domain(domain);
  labels.set_total_count(total);
  labels.set_first_index(first);
  labels.set_labels(Pack(values));
  labels.set_labels_crc32c(Crc32c(labels.labels()));
  return event;
}

v1::SegmentEvent LevelEvent() {
  v1::SegmentEvent event;
  v1::Level& level = *event.mutable_level();
  level.set_level(1);
  for (uint32_t id : {0u, 1u, 2u}) {
    v1::Node& node = *level.add_nodes();
    node.set_id(id);
    node.set_level(id == 0 ? 0 : 1);
    node.set_area(id + 1);
    if (id > 0) node.set_parent(0);
    node.set_medial_structure(Pack({id, id + 1}));
  }
  v1::Split& split = *level.add_splits();
  split.set_id(0);
  split.add_children(1);
  split.add_children(2);
  split.set_iterations(3);
  return event;
}

v1::SegmentEvent SkeletonEvent() {
  v1::SegmentEvent event;
  v1::Skeleton& skeleton = *event.mutable_skeleton();
  skeleton.set_level(1);
  skeleton.add_joints()->add_segments(1);
  v1::Joint& joint = *skeleton.add_joints();
  joint.set_parent(0);
  joint.set_kind(v1::JOINT_KIND_ARTICULATION);
  joint.mutable_position()->set_y(2);
  return event;
}

v1::SegmentEvent CompletedEvent() {
  v1::SegmentEvent event;
  v1::Completed& completed = *event.mutable_completed();
  completed.mutable_spectrum()->set_outcome(v1::CACHE_OUTCOME_HIT);
  for (uint32_t id : {1u, 2u}) {
    v1::Split& split = *completed.add_splits();
    split.set_id(id);
    split.set_stop_reason(v1::STOP_REASON_DEPTH);
  }
  return event;
}

// A good answer, in the order of events: what the tests spoil.
enum Position {
  kLevelEvent,
  kFacesBegin,
  kFacesEnd,
  kPointsEvent,
  kSkeletonEvent,
  kCompletedEvent,
};
std::vector<v1::SegmentEvent> GoodAnswer() {
  return {LevelEvent(),
          LabelsEvent(v1::LABEL_DOMAIN_FACE, kFaces, 0, {1, 1, 2}),
          LabelsEvent(v1::LABEL_DOMAIN_FACE, kFaces, 3, {2}),
          LabelsEvent(v1::LABEL_DOMAIN_VERTEX, kPoints, 0, {1, 1, 2, 2, kNone}),
          SkeletonEvent(),
          CompletedEvent()};
}

absl::StatusOr<Segmentation> Build(std::vector<v1::SegmentEvent> events) {
  AnswerBuilder builder(kFaces, kPoints);
  uint64_t sequence = 0;
  for (v1::SegmentEvent& event : events) {
    event.set_sequence(++sequence);
    if (absl::Status status = builder.Add(event); !status.ok()) return status;
  }
  return builder.Finish();
}

TEST(AnswerBuilderTest, PutsAnAnswerTogether) {
  const absl::StatusOr<Segmentation> answer = Build(GoodAnswer());
  ASSERT_TRUE(answer.ok()) << answer.status();
  ASSERT_EQ(answer->nodes.size(), 3u);
  EXPECT_THAT(answer->nodes[0].children, ElementsAre(1, 2));
  EXPECT_EQ(answer->nodes[0].iterations, 3u);
  EXPECT_EQ(answer->nodes[0].stop_reason, "");
  EXPECT_EQ(answer->nodes[1].parent, 0u);
  EXPECT_EQ(answer->nodes[1].stop_reason, "depth");
  EXPECT_THAT(answer->nodes[2].medial_structure, ElementsAre(2, 3));
  ASSERT_EQ(answer->levels.size(), 1u);
  EXPECT_THAT(answer->levels[0].face_labels, ElementsAre(1, 1, 2, 2));
  EXPECT_THAT(answer->levels[0].vertex_labels, ElementsAre(1, 1, 2, 2, kNone));
  ASSERT_EQ(answer->levels[0].skeleton.joints.size(), 2u);
  EXPECT_TRUE(answer->levels[0].skeleton.joints[1].articulation);
  EXPECT_EQ(answer->levels[0].skeleton.joints[1].position[1], 2);
  EXPECT_EQ(answer->cache["outcome"], "hit");
}

// The first `count` items of a list, removed from it.
template <typename List>
void Truncate(List* list, int count) {
  list->DeleteSubrange(count, list->size() - count);
}

TEST(AnswerBuilderTest, JoinsTheMessagesOfALargeLevel) {
  std::vector<v1::SegmentEvent> events = GoodAnswer();
  v1::SegmentEvent rest = events[kLevelEvent];
  Truncate(events[kLevelEvent].mutable_level()->mutable_nodes(), 2);
  events[kLevelEvent].mutable_level()->clear_splits();
  v1::Level& level = *rest.mutable_level();
  level.mutable_nodes()->DeleteSubrange(0, 1);
  level.mutable_nodes(0)->Clear();
  level.mutable_nodes(0)->set_id(1);
  level.mutable_nodes(0)->set_medial_structure(Pack({4}));
  events.insert(events.begin() + kLevelEvent + 1, rest);

  const absl::StatusOr<Segmentation> answer = Build(events);
  ASSERT_TRUE(answer.ok()) << answer.status();
  EXPECT_EQ(answer->levels.size(), 1u);
  ASSERT_EQ(answer->nodes.size(), 3u);
  EXPECT_THAT(answer->nodes[0].children, ElementsAre(1, 2));
  EXPECT_THAT(answer->nodes[1].medial_structure, ElementsAre(1, 2, 4));
  EXPECT_EQ(answer->nodes[1].parent, 0u);
  EXPECT_EQ(answer->nodes[1].area, 2);
  EXPECT_THAT(answer->nodes[2].medial_structure, ElementsAre(2, 3));
}

TEST(AnswerBuilderTest, JoinsTheMessagesOfALargeSkeleton) {
  std::vector<v1::SegmentEvent> events = GoodAnswer();
  v1::SegmentEvent rest = events[kSkeletonEvent];
  Truncate(events[kSkeletonEvent].mutable_skeleton()->mutable_joints(), 1);
  rest.mutable_skeleton()->mutable_joints()->DeleteSubrange(0, 1);
  events.insert(events.begin() + kSkeletonEvent + 1, rest);

  const absl::StatusOr<Segmentation> answer = Build(events);
  ASSERT_TRUE(answer.ok()) << answer.status();
  const std::vector<Joint>& joints = answer->levels[0].skeleton.joints;
  ASSERT_EQ(joints.size(), 2u);
  EXPECT_THAT(joints[0].segments, ElementsAre(1));
  EXPECT_EQ(joints[1].id, 1u);
  EXPECT_EQ(joints[1].parent, 0u);
}

TEST(AnswerBuilderTest, RefusesAGapInTheSequence) {
  AnswerBuilder builder(kFaces, kPoints);
  v1::SegmentEvent event;
  event.set_sequence(2);
  EXPECT_EQ(builder.Add(event).code(), absl::StatusCode::kDataLoss);
}

struct Lie {
  const char* name;
  std::function<void(std::vector<v1::SegmentEvent>&)> tell;
};

class LyingServerTest : public ::testing::TestWithParam<Lie> {};

TEST_P(LyingServerTest, IsCaught) {
  std::vector<v1::SegmentEvent> events = GoodAnswer();
  GetParam().tell(events);
  const absl::Status status = Build(std::move(events)).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("answer is broken"));
}

v1::Labels& Faces(std::vector<v1::SegmentEvent>& e) {
  return *e[kFacesBegin].mutable_labels();
}
v1::Level& LevelOf(std::vector<v1::SegmentEvent>& e) {
  return *e[kLevelEvent].mutable_level();
}
void Relabel(std::vector<v1::SegmentEvent>& e,
             const std::vector<uint32_t>& values) {
  e[kFacesBegin] = LabelsEvent(v1::LABEL_DOMAIN_FACE, kFaces, 0, values);
}

using Events = std::vector<v1::SegmentEvent>;

INSTANTIATE_TEST_SUITE_P(
    All, LyingServerTest,
    ::testing::Values(
        Lie{"ChecksumOfLabels",
            [](Events& e) { Faces(e).set_labels_crc32c(7); }},
        Lie{"HalfALabel",
            [](Events& e) {
              Faces(e).mutable_labels()->pop_back();
              Faces(e).set_labels_crc32c(Crc32c(Faces(e).labels()));
            }},
        Lie{"FourBillionLabels",
            [](Events& e) { Faces(e).set_total_count(kNone); }},
        Lie{"MoreLabelsThanFaces",
            [](Events& e) {
              Relabel(e, {1, 1, 1, 2, 2, 2});
            }},
        Lie{"GapInLabels",
            [](Events& e) {
              e[kFacesEnd].mutable_labels()->set_first_index(9);
            }},
        Lie{"MissingLabels", [](Events& e) { e.erase(e.begin() + kFacesEnd); }},
        Lie{"LabelOfNoNode",
            [](Events& e) {
              Relabel(e, {1, 1, 77});
            }},
        Lie{"LabelsOfALevelThatNeverCame",
            [](Events& e) { Faces(e).set_level(2); }},
        Lie{"LabelsOfLevelZero", [](Events& e) { Faces(e).set_level(0); }},
        Lie{"LevelsOutOfOrder", [](Events& e) { LevelOf(e).set_level(2); }},
        Lie{"LevelTwice",
            [](Events& e) { e.insert(e.begin(), e[kLevelEvent]); }},
        Lie{"LevelThatGoesOnAfterItsLabels",
            [](Events& e) {
              v1::SegmentEvent more;
              more.mutable_level()->set_level(1);
              e.insert(e.begin() + kSkeletonEvent, more);
            }},
        Lie{"NodeTwice",
            [](Events& e) { *LevelOf(e).add_nodes() = LevelOf(e).nodes(1); }},
        Lie{"MoreNodesThanATreeHas",
            [](Events& e) {
              for (uint32_t id = 3; id < 20; ++id) {
                LevelOf(e).add_nodes()->set_id(id);
              }
            }},
        Lie{"MedialPointOutOfRange",
            [](Events& e) {
              LevelOf(e).mutable_nodes(1)->set_medial_structure(
                  Pack({kPoints}));
            }},
        Lie{"MedialStructureTooLong",
            [](Events& e) {
              LevelOf(e).mutable_nodes(1)->set_medial_structure(
                  Pack(std::vector<uint32_t>(1000, 0)));
            }},
        Lie{"SplitOfNoNode",
            [](Events& e) { LevelOf(e).mutable_splits(0)->set_id(9); }},
        Lie{"ChildThatDoesNotExist",
            [](Events& e) {
              LevelOf(e).mutable_splits(0)->set_children(1, 40);
            }},
        Lie{"ChildTwice",
            [](Events& e) {
              LevelOf(e).mutable_splits(0)->set_children(1, 1);
            }},
        Lie{"ItsOwnChild",
            [](Events& e) {
              LevelOf(e).mutable_splits(0)->set_children(0, 0);
            }},
        Lie{"ChildOfAnother",
            [](Events& e) { LevelOf(e).mutable_nodes(2)->set_parent(1); }},
        Lie{"OrphanNode",
            [](Events& e) {
              LevelOf(e).mutable_splits(0)->mutable_children()->RemoveLast();
            }},
        Lie{"TwoRoots",
            [](Events& e) { LevelOf(e).mutable_nodes(1)->clear_parent(); }},
        Lie{"RootWithAParent",
            [](Events& e) { LevelOf(e).mutable_nodes(0)->set_parent(1); }},
        Lie{"JointBeforeItsParent",
            [](Events& e) {
              e[kSkeletonEvent]
                  .mutable_skeleton()
                  ->mutable_joints(1)
                  ->set_parent(1);
            }},
        Lie{"SkeletonWithTwoRoots",
            [](Events& e) {
              e[kSkeletonEvent]
                  .mutable_skeleton()
                  ->mutable_joints(1)
                  ->clear_parent();
            }},
        Lie{"JointOfNoSegment",
            [](Events& e) {
              e[kSkeletonEvent]
                  .mutable_skeleton()
                  ->mutable_joints(0)
                  ->set_segments(0, 99);
            }},
        Lie{"JointOfThreeSegments",
            [](Events& e) {
              v1::Joint& joint =
                  *e[kSkeletonEvent].mutable_skeleton()->mutable_joints(0);
              joint.add_segments(1);
              joint.add_segments(2);
            }},
        Lie{"SkeletonLargerThanTheMesh",
            [](Events& e) {
              v1::Skeleton& skeleton = *e[kSkeletonEvent].mutable_skeleton();
              for (int i = 0; i < 7; ++i) {
                skeleton.add_joints()->set_parent(0);
              }
            }},
        Lie{"SkeletonTwice",
            [](Events& e) {
              e.insert(e.begin() + kSkeletonEvent, e[kSkeletonEvent]);
            }},
        Lie{"NoEnd", [](Events& e) { e.pop_back(); }},
        Lie{"EventAfterTheEnd", [](Events& e) { e.push_back(e[kLevelEvent]); }},
        Lie{"NothingButAnEnd",
            [](Events& e) {
              v1::SegmentEvent end;
              end.mutable_completed();
              e = {end};
            }}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace marrow::client
