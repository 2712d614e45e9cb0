#include "server/cut_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tests/server/service_fixture.h"

namespace marrow::testing {
namespace {

using ::testing::HasSubstr;

class CutTest : public ServiceTest {
 protected:
  static v1::SegmentRequest Merging(int depth = 3) {
    v1::SegmentRequest request = Request(StarPayload(depth));
    request.mutable_options()->set_method(v1::METHOD_MERGE);
    request.mutable_outputs()->add_label_domains(v1::LABEL_DOMAIN_FACE);
    request.mutable_outputs()->add_label_domains(v1::LABEL_DOMAIN_VERTEX);
    return request;
  }

  // Of the mesh that was segmented by `request`, which this segments.
  v1::CutRequest AfterSegmenting(const v1::SegmentRequest& request) {
    const Answer answer = Segment(request);
    EXPECT_TRUE(answer.status.ok()) << answer.status.error_message();
    v1::CutRequest cut;
    *cut.mutable_mesh_digest() = answer.completed().mesh_digest();
    *cut.mutable_options() = request.options();
    *cut.mutable_outputs() = request.outputs();
    return cut;
  }

  Answer Cut(const v1::CutRequest& request) {
    grpc::ClientContext context;
    Answer answer;
    auto reader = segmentation_->Cut(&context, request);
    v1::SegmentEvent event;
    while (reader->Read(&event)) answer.events.push_back(event);
    answer.status = reader->Finish();
    return answer;
  }

  // What is told of the cut alone.
  static std::vector<std::string> CutEventsOf(const Answer& answer) {
    std::vector<std::string> events;
    for (v1::SegmentEvent event : answer.events) {
      event.clear_sequence();
      if (event.has_cut() ||
          (event.has_labels() && event.labels().level() == 0) ||
          (event.has_skeleton() && event.skeleton().level() == 0)) {
        events.push_back(event.SerializeAsString());
      }
    }
    return events;
  }

  static std::string Refusal(const Answer& answer) {
    EXPECT_FALSE(answer.status.ok());
    return ReasonIn(answer.status);
  }
};

std::vector<v1::Cut> SomeCuts() {
  std::vector<v1::Cut> cuts(6);
  cuts[1].set_level(1);
  cuts[2].set_segments(2);
  cuts[3].set_salience(0.1);
  cuts[4].set_salience(0);
  cuts[4].add_closed(1);
  cuts[5].set_segments(1);
  cuts[5].add_open(0);
  return cuts;
}

TEST_F(CutTest, TellsWhatSegmentWithThatCutTellsAndSolvesNothing) {
  options_.result_cache_bytes = 0;  // so that Segment does compute
  Start();
  std::vector<Answer> expected;
  for (const v1::Cut& cut : SomeCuts()) {
    v1::SegmentRequest request = Merging();
    *request.mutable_cut() = cut;
    expected.push_back(Segment(request));
    ASSERT_TRUE(expected.back().status.ok());
    ASSERT_EQ(CutEventsOf(expected.back()).size(), 4u);
  }
  options_.result_cache_bytes = 1 << 30;
  Start();
  v1::CutRequest request = AfterSegmenting(Merging());
  const int runs = runs_;
  const int solved = solver_->calls;
  for (size_t i = 0; i < expected.size(); ++i) {
    *request.mutable_cut() = SomeCuts()[i];
    const Answer answer = Cut(request);
    ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
    EXPECT_TRUE(CutEventsOf(answer) == CutEventsOf(expected[i])) << i;
    EXPECT_TRUE(answer.events.front().has_accepted());
    EXPECT_EQ(answer.accepted().result(), v1::CACHE_OUTCOME_HIT);
    for (size_t e = 0; e < answer.events.size(); ++e) {
      EXPECT_EQ(answer.events[e].sequence(), e + 1);
    }
    const v1::Completed& completed = answer.completed();
    EXPECT_EQ(completed.result(), v1::CACHE_OUTCOME_HIT);
    EXPECT_EQ(completed.spectrum().outcome(), v1::CACHE_OUTCOME_HIT);
    EXPECT_EQ(completed.spectrum().solver_runs(), 0u);
    EXPECT_EQ(completed.spectrum().eigen_pairs(),
              expected[i].completed().spectrum().eigen_pairs());
    EXPECT_EQ(completed.geometry_digest().sha256(),
              expected[i].completed().geometry_digest().sha256());
    EXPECT_LT(completed.timings().segments_seconds(), 1);
  }
  EXPECT_EQ(runs_, runs);
  EXPECT_EQ(solver_->calls, solved);
}

TEST_F(CutTest, SegmentSendsNoCutThatIsNotAskedFor) {
  Start();
  const Answer without = Segment(Merging());
  EXPECT_TRUE(CutEventsOf(without).empty());
  v1::SegmentRequest request = Merging();
  request.mutable_cut();
  request.mutable_outputs()->set_omit_skeletons(true);
  const Answer with = Segment(request);
  EXPECT_EQ(CutEventsOf(with).size(), 3u);
  EXPECT_TRUE(with.events[with.events.size() - 4].has_cut());
}

TEST_F(CutTest, TheAutomaticCutIsLevelTwoOrOneWhereThereIsNoTwo) {
  Start();
  for (v1::Method method : {v1::METHOD_PAPER, v1::METHOD_MERGE}) {
    v1::SegmentRequest request = Merging();
    request.mutable_options()->set_method(method);
    request.mutable_cut();
    const Answer answer = Segment(request);
    std::map<uint32_t, std::string> labels;
    for (const v1::SegmentEvent& event : answer.events) {
      if (event.labels().domain() != v1::LABEL_DOMAIN_FACE) continue;
      labels[event.labels().level()] += event.labels().labels();
    }
    EXPECT_FALSE(labels[0].empty());
    EXPECT_TRUE(labels[0] == labels.rbegin()->second);
  }
}

TEST_F(CutTest, WhatIsNotKeptIsNotFoundAndSaysWhatToDo) {
  Start();
  v1::CutRequest request = AfterSegmenting(Merging());
  v1::CutRequest other = request;
  other.mutable_options()->set_levels(1);
  EXPECT_EQ(Refusal(Cut(other)), "NOT_CACHED");
  other = request;
  other.mutable_mesh_digest()->set_sha256(std::string(32, 'x'));
  const Answer answer = Cut(other);
  EXPECT_EQ(Refusal(answer), "NOT_CACHED");
  EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_THAT(answer.status.error_message(), HasSubstr("call Segmentation"));
  EXPECT_TRUE(Cut(request).status.ok());
}

TEST_F(CutTest, WhatIsOldestGoesOnceTheMemoryIsFull) {
  options_.result_cache_bytes = 0;
  Start();
  EXPECT_EQ(Refusal(Cut(AfterSegmenting(Merging()))), "NOT_CACHED");
  // Room for two of them.
  options_.result_cache_bytes = 600 << 10;
  Start();
  const v1::CutRequest first = AfterSegmenting(Merging());
  EXPECT_TRUE(Cut(first).status.ok());
  for (const double kappa : {1.0, 1.1, 1.2, 1.3}) {
    v1::SegmentRequest another = Merging();
    another.mutable_options()->set_kappa(kappa);
    EXPECT_TRUE(Cut(AfterSegmenting(another)).status.ok());
  }
  EXPECT_EQ(Refusal(Cut(first)), "NOT_CACHED");
}

TEST_F(CutTest, ImpossibleCutsNameTheField) {
  Start();
  v1::CutRequest request = AfterSegmenting(Merging());
  const auto refused = [&](const v1::Cut& cut) {
    *request.mutable_cut() = cut;
    const Answer answer = Cut(request);
    v1::SegmentRequest segment = Merging();
    *segment.mutable_cut() = cut;
    EXPECT_EQ(Refusal(Segment(segment)), Refusal(answer));
    EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    return ReasonIn(answer.status);
  };
  v1::Cut cut;
  cut.set_level(3);
  EXPECT_EQ(refused(cut), "INVALID_PARAMETER cut.level");
  cut.set_segments(0);
  EXPECT_EQ(refused(cut), "INVALID_PARAMETER cut.segments");
  cut.set_salience(2);
  EXPECT_EQ(refused(cut), "INVALID_PARAMETER cut.salience");
  cut.clear_by();
  cut.add_closed(99999);
  EXPECT_EQ(refused(cut), "INVALID_PARAMETER cut.closed[0]");
  cut.clear_closed();
  cut.add_open(99999);
  EXPECT_EQ(refused(cut), "INVALID_PARAMETER cut.open[0]");

  request.clear_cut();
  request.mutable_outputs()->add_label_domains(v1::LABEL_DOMAIN_UNSPECIFIED);
  EXPECT_EQ(Refusal(Cut(request)),
            "INVALID_PARAMETER outputs.label_domains[2]");
  request.clear_outputs();
  request.mutable_mesh_digest()->set_sha256("short");
  EXPECT_EQ(Refusal(Cut(request)), "INVALID_PARAMETER mesh_digest.sha256");
  request.clear_mesh_digest();
  EXPECT_EQ(Refusal(Cut(request)), "INVALID_PARAMETER mesh_digest");
}

TEST_F(CutTest, AFailedCutLeavesTheResultBehind) {
  Start();
  v1::SegmentRequest request = Merging();
  request.mutable_cut()->add_open(99999);
  EXPECT_EQ(Refusal(Segment(request)), "INVALID_PARAMETER cut.open[0]");
  request.clear_cut();
  EXPECT_TRUE(Cut(AfterSegmenting(request)).status.ok());
  EXPECT_EQ(runs_, 1);
}

TEST_F(CutTest, AWarmSegmentTellsTheSameWithoutComputing) {
  Start();
  v1::SegmentRequest request = Merging();
  request.mutable_cut()->set_segments(3);
  const Answer cold = Segment(request);
  const Answer warm = Segment(request);
  EXPECT_TRUE(warm.Essence() == cold.Essence());
  EXPECT_EQ(cold.completed().result(), v1::CACHE_OUTCOME_MISS);
  EXPECT_EQ(warm.completed().result(), v1::CACHE_OUTCOME_HIT);
  EXPECT_EQ(warm.completed().spectrum().solver_runs(), 0u);
  EXPECT_EQ(runs_, 1);
}

TEST_F(CutTest, NeitherCutsNorWarmSegmentsWaitForSolversOrAreRefused) {
  options_.compute_threads = 1;
  options_.max_queued_jobs = 0;
  Start();
  const v1::CutRequest request = AfterSegmenting(Merging());
  solver_->hold = true;
  grpc::ClientContext context;
  auto reader = segmentation_->Segment(&context, Merging(4));
  EXPECT_TRUE(WaitUntil([&] { return solver_->calls == 2; }));
  EXPECT_TRUE(Cut(request).status.ok());
  grpc::ClientContext bounded;
  bounded.set_deadline(std::chrono::system_clock::now() +
                       std::chrono::seconds(30));
  const Answer warm = Segment(Merging(), bounded);
  ASSERT_TRUE(warm.status.ok()) << warm.status.error_message();
  EXPECT_EQ(warm.completed().result(), v1::CACHE_OUTCOME_HIT);
  solver_->hold = false;
  v1::SegmentEvent event;
  while (reader->Read(&event)) {
  }
  EXPECT_TRUE(reader->Finish().ok());
}

TEST_F(CutTest, AKnownDigestOfAnotherSizeIsNotTaken) {
  Start();
  v1::CutRequest request = AfterSegmenting(Merging());
  v1::MeshDigest& digest = *request.mutable_mesh_digest();
  digest.set_size_bytes(digest.size_bytes() + 1);
  EXPECT_EQ(Refusal(Cut(request)), "DIGEST_MISMATCH");
}

}  // namespace
}  // namespace marrow::testing
