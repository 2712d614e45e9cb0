#include "server/job.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "marrow/v1/segmentation_service.pb.h"

namespace marrow {
namespace {

using TestJob = Job<v1::SegmentEvent>;

struct Listener : JobListener {
  void OnJobChanged() override { ++changes; }
  int changes = 0;
};

v1::SegmentEvent Warn(const std::string& code) {
  v1::SegmentEvent event;
  event.mutable_warning()->set_code(code);
  return event;
}

class JobTest : public ::testing::Test {
 protected:
  std::shared_ptr<TestJob> NewJob() {
    return std::make_shared<TestJob>("job", std::chrono::hours(1));
  }

  std::shared_ptr<TestJob> job_ = NewJob();
  std::shared_ptr<Listener> a_ = std::make_shared<Listener>();
  std::shared_ptr<Listener> b_ = std::make_shared<Listener>();
};

TEST_F(JobTest, LateReadersSeeTheSameEvents) {
  ASSERT_TRUE(job_->Join(a_));
  EXPECT_TRUE(job_->Append(Warn("one")));
  EXPECT_EQ(a_->changes, 1);
  ASSERT_TRUE(job_->Join(b_));
  job_->Complete(Warn("two"));
  EXPECT_EQ(a_->changes, 2);
  EXPECT_EQ(b_->changes, 1);
  EXPECT_EQ(job_->Read(1).event->warning().code(), "one");
  EXPECT_EQ(job_->Read(2).event->warning().code(), "two");
  EXPECT_EQ(job_->Read(2).event->sequence(), 2u);
  EXPECT_EQ(job_->Read(3).event, nullptr);
  EXPECT_EQ(job_->Read(3).end, absl::OkStatus());
}

TEST_F(JobTest, ThereIsNothingToReadBeforeItIsAppended) {
  EXPECT_EQ(job_->Read(1).event, nullptr);
  EXPECT_EQ(job_->Read(1).end, std::nullopt);
}

TEST_F(JobTest, IsCancelledWhenTheLastListenerLeaves) {
  ASSERT_TRUE(job_->Join(a_));
  ASSERT_TRUE(job_->Join(b_));
  job_->Leave(a_.get());
  EXPECT_FALSE(job_->cancel()->IsCancelled());
  job_->Leave(b_.get());
  EXPECT_TRUE(job_->cancel()->IsCancelled());
  EXPECT_FALSE(job_->Append(Warn("nobody listens")));
  EXPECT_FALSE(job_->Join(a_));
}

TEST_F(JobTest, TakesNoListenersAfterItsEnd) {
  job_->Fail(absl::InternalError("failed"));
  EXPECT_FALSE(job_->Join(a_));
  EXPECT_EQ(job_->Read(1).end, absl::InternalError("failed"));
}

TEST_F(JobTest, ProgressNeverFalls) {
  job_->Progress(v1::STAGE_MESH, 0.5);
  job_->Progress(v1::STAGE_SPECTRUM, 0.25);
  EXPECT_EQ(job_->Read(2).event->progress().stage(), v1::STAGE_SPECTRUM);
  EXPECT_EQ(job_->Read(2).event->progress().fraction(), 0.5);
}

TEST_F(JobTest, ProgressOfAStageIsThinnedOut) {
  for (int i = 0; i < 1000; ++i) job_->Progress(v1::STAGE_MESH, i / 1000.0);
  EXPECT_EQ(job_->Read(100).event, nullptr);
}

TEST_F(JobTest, SilenceIsFilledUntilTheEnd) {
  job_->Progress(v1::STAGE_SPECTRUM, 0.5);
  const auto now = Clock::now();
  job_->Tick(now + std::chrono::minutes(59));
  EXPECT_EQ(job_->Read(2).event, nullptr);
  job_->Tick(now + std::chrono::minutes(61));
  EXPECT_EQ(job_->Read(2).event->progress().stage(), v1::STAGE_SPECTRUM);
  job_->Complete(Warn("end"));
  job_->Tick(now + std::chrono::hours(9));
  EXPECT_EQ(job_->Read(4).event, nullptr);
}

TEST_F(JobTest, LazyEventsFollowTheLog) {
  job_->Append(Warn("first"));
  job_->CompleteLazily(2, [](uint64_t i) { return Warn(std::to_string(i)); });
  EXPECT_EQ(job_->Read(1).event->warning().code(), "first");
  EXPECT_EQ(job_->Read(3).event->warning().code(), "1");
  EXPECT_EQ(job_->Read(3).event->sequence(), 3u);
  EXPECT_EQ(job_->Read(4).end, absl::OkStatus());
}

TEST_F(JobTest, TheTableSharesAJobUntilItEndsOrIsCancelled) {
  JobTable<v1::SegmentEvent> table;
  const auto create = [this] { return NewJob(); };
  const auto first = table.Join("key", a_, create);
  EXPECT_TRUE(first.is_new);
  const auto second = table.Join("key", b_, create);
  EXPECT_FALSE(second.is_new);
  EXPECT_EQ(first.job, second.job);
  EXPECT_TRUE(table.Join("other", a_, create).is_new);

  first.job->Leave(a_.get());
  first.job->Leave(b_.get());
  const auto third = table.Join("key", a_, create);
  EXPECT_TRUE(third.is_new);
  table.Remove("key", first.job.get());
  EXPECT_FALSE(table.Join("key", b_, create).is_new);
  table.Remove("key", third.job.get());
  EXPECT_TRUE(table.Join("key", b_, create).is_new);
}

}  // namespace
}  // namespace marrow
