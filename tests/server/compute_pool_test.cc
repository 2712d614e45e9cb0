#include "server/compute_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "absl/synchronization/notification.h"
#include "core/base/error_reason.h"

namespace marrow {
namespace {

std::shared_ptr<CancelToken> Token() { return std::make_shared<CancelToken>(); }

TEST(ComputePoolTest, RunsEveryTaskOnce) {
  std::atomic<int> runs{0};
  {
    ComputePool pool(3, 1000);
    for (int i = 0; i < 1000; ++i) {
      EXPECT_TRUE(pool.Submit(Token(), [&] { ++runs; }).ok());
    }
  }
  EXPECT_EQ(runs, 1000);
}

// A pool of one thread, which is busy, with room for one task to wait.
class BusyPoolTest : public ::testing::Test {
 protected:
  BusyPoolTest() {
    EXPECT_TRUE(pool_
                    .Submit(Token(),
                            [this] {
                              busy_.Notify();
                              release_.WaitForNotification();
                            })
                    .ok());
    busy_.WaitForNotification();
  }
  ~BusyPoolTest() override { release_.Notify(); }

  absl::Notification busy_;
  absl::Notification release_;
  ComputePool pool_{1, 1};
};

TEST_F(BusyPoolTest, RefusesWhatTheQueueCannotHold) {
  EXPECT_TRUE(pool_.Submit(Token(), [] {}).ok());
  const absl::Status refused =
      pool_.Submit(Token(), [] { FAIL() << "was refused"; });
  EXPECT_EQ(refused.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(ReasonOf(refused), kReasonOverloaded);
}

TEST_F(BusyPoolTest, CancelledTasksMakeRoom) {
  const auto cancelled = Token();
  bool ran = false;
  EXPECT_TRUE(pool_.Submit(cancelled, [&ran] { ran = true; }).ok());
  cancelled->Cancel();
  EXPECT_TRUE(pool_.Submit(Token(), [] {}).ok());
  EXPECT_TRUE(ran);
}

TEST(ComputePoolTest, WithoutAQueueIdleThreadsStillTakeTasks) {
  absl::Notification done;
  ComputePool pool(1, 0);
  EXPECT_TRUE(pool.Submit(Token(), [&] { done.Notify(); }).ok());
  done.WaitForNotification();
}

TEST(ComputePoolTest, WhoHasAnAnswerIsNotRefusedForIt) {
  absl::Notification answered, taken;
  ComputePool pool(1, 0);
  EXPECT_TRUE(pool.Submit(Token(),
                          [&] {
                            ComputePool::CountAsIdle();
                            answered.Notify();
                            taken.WaitForNotification();
                          })
                  .ok());
  answered.WaitForNotification();
  EXPECT_TRUE(pool.Submit(Token(), [] {}).ok());
  EXPECT_EQ(pool.Submit(Token(), [] {}).code(), absl::StatusCode::kUnavailable);
  taken.Notify();
  ComputePool::CountAsIdle();  // a thread of no pool
}

}  // namespace
}  // namespace marrow
