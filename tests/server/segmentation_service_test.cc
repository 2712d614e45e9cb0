#include "server/segmentation_service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "absl/synchronization/notification.h"
#include "core/base/crc32c.h"
#include "tests/server/service_fixture.h"
#include "tests/testing/draco_encode.h"
#include "tests/testing/shapes.h"

namespace marrow::testing {
namespace {

class SegmentTest : public ServiceTest {
 protected:
  // The star by the paper's method, which splits it twice; merging finds
  // nothing more at its second threshold.
  v1::SegmentRequest TwoLevels() {
    v1::SegmentRequest request = Request(StarPayload(3));
    request.mutable_options()->set_method(v1::METHOD_PAPER);
    return request;
  }
};

// "accepted mesh_report level labels ..." without progress.
std::string Order(const Answer& answer) {
  static const char* const kNames[] = {
      "?",     "?",      "accepted", "progress", "mesh_report",
      "level", "labels", "skeleton", "warning",  "completed"};
  std::string order;
  for (const v1::SegmentEvent& event : answer.events) {
    if (!event.has_progress()) {
      order += std::string(kNames[event.event_case()]) + " ";
    }
  }
  return order;
}

TEST_F(SegmentTest, EventsComeInTheOrderOfTheContract) {
  Start();
  v1::SegmentRequest request = TwoLevels();
  request.mutable_outputs()->add_label_domains(v1::LABEL_DOMAIN_FACE);
  request.mutable_outputs()->add_label_domains(v1::LABEL_DOMAIN_VERTEX);
  const Answer answer = Segment(request);
  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  EXPECT_EQ(Order(answer),
            "accepted mesh_report level labels labels skeleton level labels "
            "labels skeleton completed ");
  double fraction = 0;
  for (size_t i = 0; i < answer.events.size(); ++i) {
    EXPECT_EQ(answer.events[i].sequence(), i + 1);
    if (!answer.events[i].has_progress()) continue;
    EXPECT_GE(answer.events[i].progress().fraction(), fraction);
    fraction = answer.events[i].progress().fraction();
  }
  EXPECT_EQ(answer.completed().spectrum().outcome(), v1::CACHE_OUTCOME_MISS);
  EXPECT_EQ(answer.completed().spectrum().solver_runs(), 1u);
  EXPECT_EQ(answer.completed().spectrum().eigen_pairs(), 20u);
  EXPECT_GT(answer.completed().timings().first_level_seconds(), 0);
}

TEST_F(SegmentTest, WarningsAboutTheMeshFollowItsReport) {
  Start();
  v1::SegmentRequest request =
      Request(EncodeDraco(Apart(Icosphere(2), Icosphere(1))));
  request.mutable_outputs()->set_omit_skeletons(true);
  request.mutable_options()->set_levels(1);
  const Answer answer = Segment(request);
  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  EXPECT_EQ(Order(answer),
            "accepted mesh_report warning level labels completed ");
  for (const v1::SegmentEvent& event : answer.events) {
    if (!event.has_warning()) continue;
    EXPECT_EQ(event.warning().code(), "SEVERAL_BODIES");
    EXPECT_THAT(event.warning().message(), ::testing::HasSubstr("2 bodies"));
  }
}

TEST_F(SegmentTest, EveryFaceHasALabelThatIsASegment) {
  Start();
  const Answer answer = Segment(TwoLevels());
  std::set<uint32_t> segments;
  int labelled = 0;
  for (const v1::SegmentEvent& event : answer.events) {
    if (event.has_level()) {
      segments = {event.level().segments().begin(),
                  event.level().segments().end()};
      EXPECT_GT(segments.size(), 3u);
    }
    if (!event.has_labels()) continue;
    const std::string& bytes = event.labels().labels();
    EXPECT_EQ(event.labels().total_count(), 1280u);
    EXPECT_EQ(event.labels().labels_crc32c(), Crc32c(bytes));
    std::vector<uint32_t> labels(bytes.size() / 4);
    std::memcpy(labels.data(), bytes.data(), bytes.size());
    EXPECT_EQ(labels.size(), 1280u);
    for (const uint32_t label : labels) {
      labelled += segments.contains(label);
    }
  }
  EXPECT_EQ(labelled, 2 * 1280);
}

TEST_F(SegmentTest, OnlyWhatIsAskedForIsSent) {
  Start();
  v1::SegmentRequest request = TwoLevels();
  request.mutable_outputs()->add_levels(2);
  request.mutable_outputs()->set_omit_skeletons(true);
  const Answer answer = Segment(request);
  EXPECT_EQ(Order(answer), "accepted mesh_report level labels completed ");
}

TEST_F(SegmentTest, ASecondCallDoesNotTouchTheSolver) {
  Start();
  const v1::SegmentRequest request = Request(StarPayload(3));
  const Answer cold = Segment(request);
  const Answer warm = Segment(request);
  ASSERT_TRUE(warm.status.ok());
  EXPECT_EQ(solver_->calls, 1);
  EXPECT_EQ(warm.completed().spectrum().outcome(), v1::CACHE_OUTCOME_HIT);
  EXPECT_EQ(warm.completed().spectrum().solver_runs(), 0u);
  EXPECT_EQ(cold.Essence(), warm.Essence());
}

TEST_F(SegmentTest, WhetherTheResultIsKeptIsToldFirst) {
  Start();
  v1::SegmentRequest request = Request(StarPayload(3));
  EXPECT_EQ(Segment(request).accepted().result(), v1::CACHE_OUTCOME_MISS);
  EXPECT_EQ(Segment(request).accepted().result(), v1::CACHE_OUTCOME_HIT);
  EXPECT_EQ(runs_, 1);
  request.mutable_options()->set_levels(1);
  const Answer other = Segment(request);
  EXPECT_EQ(other.accepted().result(), v1::CACHE_OUTCOME_MISS);
  EXPECT_EQ(other.completed().spectrum().outcome(), v1::CACHE_OUTCOME_HIT);
  EXPECT_EQ(solver_->calls, 1);
}

TEST_F(SegmentTest, AnotherKappaHitsTheSameSpectrum) {
  Start();
  v1::SegmentRequest request = Request(StarPayload(3));
  Segment(request);
  request.mutable_options()->set_kappa(1);
  EXPECT_EQ(Segment(request).completed().spectrum().outcome(),
            v1::CACHE_OUTCOME_HIT);
  EXPECT_EQ(solver_->calls, 1);
}

TEST_F(SegmentTest, TheMethodsAreTwoJobsOverOneSpectrum) {
  Start();
  v1::SegmentRequest request = Request(StarPayload(3));
  request.mutable_options()->set_method(v1::METHOD_PAPER);
  const Answer paper = Segment(request);
  request.mutable_options()->set_method(v1::METHOD_MERGE);
  const Answer merge = Segment(request);
  ASSERT_TRUE(merge.status.ok());
  EXPECT_EQ(merge.completed().spectrum().outcome(), v1::CACHE_OUTCOME_HIT);
  EXPECT_NE(merge.Essence(), paper.Essence());
  EXPECT_EQ(merge.Essence(), Segment(request).Essence());
}

// Stands between the pipeline and the server's sink, and does not return from
// level 1 before the test says so.
class GateSink : public Sink {
 public:
  GateSink(Sink& sink, absl::Notification& gate) : sink_(sink), gate_(gate) {}
  bool OnProgress(Stage stage, double fraction) override {
    return sink_.OnProgress(stage, fraction);
  }
  bool OnMesh(const CanonicalMesh& mesh) override { return sink_.OnMesh(mesh); }
  bool OnLevel(const LevelResult& level) override {
    const bool go_on = sink_.OnLevel(level);
    if (level.level == 1) gate_.WaitForNotification();
    return go_on;
  }
  bool OnTree(const SegmentTree& tree) override { return sink_.OnTree(tree); }

 private:
  Sink& sink_;
  absl::Notification& gate_;
};

TEST_F(SegmentTest, LevelOneIsOnTheWireBeforeLevelTwoIsComputed) {
  absl::Notification gate;
  run_ = [&gate](std::string_view bytes, const MeshLimits& limits,
                 const SegmentationOptions& options, EigenPairSource& pairs,
                 const CancelToken& cancel, Sink& sink) {
    GateSink gated(sink, gate);
    return marrow::Run(bytes, limits, options, pairs, cancel, gated);
  };
  Start();
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() +
                       std::chrono::seconds(60));
  auto reader = segmentation_->Segment(&context, Request(StarPayload(3)));
  v1::SegmentEvent event;
  while (reader->Read(&event) && !event.has_skeleton()) {
  }
  EXPECT_EQ(event.skeleton().level(), 1u);
  gate.Notify();
  while (reader->Read(&event)) {
  }
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_TRUE(event.has_completed());
}

TEST_F(SegmentTest, ConcurrentEqualRequestsAreComputedOnce) {
  Start();
  solver_->hold = true;
  const v1::SegmentRequest request = Request(StarPayload(3));
  std::vector<Answer> answers(6);
  std::atomic<int> accepted{0};
  std::vector<std::thread> clients;
  for (Answer& answer : answers) {
    clients.emplace_back([&] {
      grpc::ClientContext context;
      auto reader = segmentation_->Segment(&context, request);
      v1::SegmentEvent event;
      while (reader->Read(&event)) {
        accepted += event.has_accepted();
        answer.events.push_back(event);
      }
      answer.status = reader->Finish();
    });
  }
  EXPECT_TRUE(WaitUntil([&] { return accepted == 6; }));
  solver_->hold = false;
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(runs_, 1);
  EXPECT_EQ(solver_->calls, 1);
  int misses = 0;
  for (const Answer& answer : answers) {
    ASSERT_TRUE(answer.status.ok());
    EXPECT_EQ(answer.Essence(), answers[0].Essence());
    const v1::SpectrumUse& use = answer.completed().spectrum();
    misses += use.outcome() == v1::CACHE_OUTCOME_MISS && use.solver_runs() == 1;
    EXPECT_NE(use.outcome(), v1::CACHE_OUTCOME_HIT);
    EXPECT_EQ(answer.accepted().result(), answer.completed().result());
  }
  EXPECT_EQ(misses, 1);
}

TEST_F(SegmentTest, DifferentConcurrentRequestsShareTheSolver) {
  Start();
  solver_->hold = true;
  v1::SegmentRequest request = Request(StarPayload(3));
  std::vector<Answer> answers(3);
  std::vector<std::thread> clients;
  for (int i = 0; i < 3; ++i) {
    request.mutable_options()->set_kappa(1 + i * 0.25);
    clients.emplace_back(
        [this, request, &answers, i] { answers[i] = Segment(request); });
  }
  EXPECT_TRUE(WaitUntil([&] { return runs_ == 3; }));
  solver_->hold = false;
  for (std::thread& client : clients) client.join();
  for (const Answer& answer : answers) EXPECT_TRUE(answer.status.ok());
  EXPECT_EQ(solver_->calls, 1);
}

// A call of which the first events have come, up to one of that kind.
class RunningCall {
 public:
  RunningCall(v1::SegmentationService::Stub& stub,
              const v1::SegmentRequest& request,
              v1::SegmentEvent::EventCase until = v1::SegmentEvent::kMeshReport)
      : reader_(stub.Segment(&context_, request)) {
    v1::SegmentEvent event;
    while (reader_->Read(&event) && event.event_case() != until) {
    }
    EXPECT_EQ(event.event_case(), until);
  }
  void Cancel() { context_.TryCancel(); }
  grpc::Status Finish() {
    v1::SegmentEvent event;
    while (reader_->Read(&event)) {
    }
    return reader_->Finish();
  }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<v1::SegmentEvent>> reader_;
};

TEST_F(SegmentTest, CancellingStopsTheWork) {
  Start();
  solver_->hold = true;
  RunningCall call(*segmentation_, Request(StarPayload(3)));
  ASSERT_TRUE(WaitUntil([&] { return solver_->calls == 1; }));
  const auto begin = std::chrono::steady_clock::now();
  call.Cancel();
  EXPECT_TRUE(WaitUntil([&] { return solver_->cancelled == 1; }));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(500));
  EXPECT_EQ(call.Finish().error_code(), grpc::StatusCode::CANCELLED);
  solver_->hold = false;
  EXPECT_TRUE(Segment(Request(StarPayload(3))).status.ok());
}

TEST_F(SegmentTest, TheWorkGoesOnForThoseWhoStay) {
  Start();
  solver_->hold = true;
  const v1::SegmentRequest request = Request(StarPayload(3));
  RunningCall first(*segmentation_, request);
  RunningCall second(*segmentation_, request);
  first.Cancel();
  EXPECT_EQ(first.Finish().error_code(), grpc::StatusCode::CANCELLED);
  solver_->hold = false;
  EXPECT_TRUE(second.Finish().ok());
  EXPECT_EQ(solver_->calls, 1);
  EXPECT_EQ(solver_->cancelled, 0);
}

TEST_F(SegmentTest, TheDeadlineStopsTheWork) {
  Start();
  solver_->hold = true;
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + milliseconds(300));
  EXPECT_EQ(Segment(Request(StarPayload(3)), context).status.error_code(),
            grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_TRUE(WaitUntil([&] { return solver_->cancelled == 1; }));
}

TEST_F(SegmentTest, ACallWithoutADeadlineGetsTheServers) {
  options_.default_deadline = milliseconds(300);
  Start();
  solver_->hold = true;
  const Answer answer = Segment(Request(StarPayload(3)));
  EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_EQ(ReasonIn(answer.status), "DEADLINE_EXCEEDED");
  EXPECT_TRUE(WaitUntil([&] { return solver_->cancelled == 1; }));
}

TEST_F(SegmentTest, SilentWorkGivesSignsOfLife) {
  options_.progress_interval = milliseconds(100);
  Start();
  solver_->hold = true;
  std::thread release([this] {
    std::this_thread::sleep_for(milliseconds(1500));
    solver_->hold = false;
  });
  const Answer answer = Segment(Request(StarPayload(3)));
  release.join();
  int signs = 0;
  for (const v1::SegmentEvent& event : answer.events) {
    signs += event.progress().stage() == v1::STAGE_SPECTRUM;
  }
  EXPECT_GE(signs, 5);
}

TEST_F(SegmentTest, AFullServerRefuses) {
  options_.compute_threads = 1;
  options_.max_queued_jobs = 1;
  Start();
  solver_->hold = true;
  RunningCall running(*segmentation_, Request(StarPayload(3)));
  RunningCall waiting(*segmentation_, Request(StarPayload(2)),
                      v1::SegmentEvent::kProgress);
  const Answer refused = Segment(Request(StarPayload(2, 1.5)));
  EXPECT_EQ(refused.status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(ReasonIn(refused.status), "OVERLOADED");
  solver_->hold = false;
  EXPECT_TRUE(running.Finish().ok());
  EXPECT_TRUE(waiting.Finish().ok());
}

TEST_F(SegmentTest, AClientThatReadsNothingIsCutOff) {
  options_.write_stall_limit = milliseconds(300);
  absl::Mutex mu;
  std::string code;
  options_.log = [&](const LogRecord& record) {
    absl::MutexLock lock(&mu);
    for (const auto& [name, value] : record.fields) {
      if (name == "code") code = value;
    }
  };
  // One level whose labels are far more than the connection buffers.
  run_ = [](std::string_view bytes, const MeshLimits& limits,
            const SegmentationOptions&, EigenPairSource&, const CancelToken&,
            Sink& sink) {
    const auto mesh = LoadMesh(bytes, limits);
    SegmentTree tree;
    tree.nodes.resize(1);
    const std::vector<uint32_t> labels(10'000'000, 0);
    sink.OnMesh(*mesh);
    sink.OnLevel({1, tree, labels, labels, Skeleton()});
    sink.OnTree(tree);
    return absl::OkStatus();
  };
  Start();
  grpc::ClientContext context;
  auto reader = segmentation_->Segment(&context, Request(StarPayload(1)));
  EXPECT_TRUE(WaitUntil([&] {
    absl::MutexLock lock(&mu);
    return !code.empty();
  }));
  {
    absl::MutexLock lock(&mu);
    EXPECT_EQ(code, "CANCELLED");
  }
  v1::SegmentEvent event;
  while (reader->Read(&event)) {
  }
  EXPECT_FALSE(reader->Finish().ok());
  server_.reset();  // before what its log refers to
}

}  // namespace
}  // namespace marrow::testing
