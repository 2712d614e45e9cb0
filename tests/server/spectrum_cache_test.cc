#include "server/spectrum_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include "absl/synchronization/notification.h"
#include "core/spectrum/solver.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using std::chrono::milliseconds;

CanonicalMesh MeshNamed(uint8_t name, int vertices = 100) {
  CanonicalMesh mesh;
  mesh.mesh.positions = Positions::Zero(vertices, 3);
  mesh.geometry_digest.bytes[0] = name;
  return mesh;
}

// 100 rows of count + 1 pairs; counts its calls, and may be held up or made to
// fail.
class FakeSolver : public EigenPairSource {
 public:
  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) override {
    ++calls;
    progress(0.5);
    while (hold && !cancel.IsCancelled()) {
      std::this_thread::sleep_for(milliseconds(1));
    }
    if (cancel.IsCancelled()) return cancel.Check();
    if (fail) return absl::InternalError("did not converge");
    auto pairs = std::make_shared<EigenPairs>();
    pairs->eigenvalues = Eigen::VectorXd::Zero(count + 1);
    pairs->eigenvectors.setZero(mesh.mesh.NumVertices(), count + 1);
    pairs->for_any_count = for_any_count;
    return std::shared_ptr<const EigenPairs>(pairs);
  }

  bool GivesSharedPairs(const CanonicalMesh&, uint32_t) const override {
    return gives_shared_pairs;
  }

  bool for_any_count = true;
  bool gives_shared_pairs = true;
  std::atomic<int> calls{0};
  std::atomic<bool> hold{false};
  std::atomic<bool> fail{false};
};

// Pairs with the eigenvalues 0, 1, 2 ..., as far as they are needed.
class CountingStreams : public FakeSolver {
 public:
  std::unique_ptr<EigenPairStream> Open(const CanonicalMesh&,
                                        uint32_t count) override {
    return std::make_unique<Stream>(*this, count);
  }

  std::atomic<int> extended{0};

 private:
  class Stream : public EigenPairStream {
   public:
    Stream(CountingStreams& source, uint32_t count)
        : source_(source), count_(count) {}
    absl::StatusOr<std::shared_ptr<const EigenPairs>> UpTo(
        double bound, const CancelToken& cancel,
        const ProgressCallback&) override {
      ++source_.extended;
      if (cancel.IsCancelled()) return cancel.Check();
      auto pairs = std::make_shared<EigenPairs>();
      const double last = std::min<double>(count_, std::floor(bound) + 1);
      pairs->eigenvalues = Eigen::VectorXd::LinSpaced(last + 1, 0, last);
      pairs->eigenvectors.setZero(3, pairs->eigenvalues.size());
      return std::shared_ptr<const EigenPairs>(pairs);
    }

   private:
    CountingStreams& source_;
    const uint32_t count_;
  };
};

void WaitUntil(const std::function<bool()>& done) {
  for (int i = 0; i < 5000 && !done(); ++i) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  ASSERT_TRUE(done());
}

class SpectrumCacheTest : public ::testing::Test {
 protected:
  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      SpectrumCache& cache, const CanonicalMesh& mesh, uint32_t count) {
    return cache.Get(
        mesh, count, never_, [](double) {}, use_);
  }

  std::shared_ptr<FakeSolver> solver_ = std::make_shared<FakeSolver>();
  CancelToken never_;
  SpectrumUse use_;
};

TEST_F(SpectrumCacheTest, SecondCallIsAHitOfTheSamePairs) {
  SpectrumCache cache(solver_, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1);
  EXPECT_FALSE(cache.Contains(mesh, 10));
  const auto first = Get(cache, mesh, 10);
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(use_.outcome, CacheOutcome::kMiss);
  EXPECT_EQ(use_.solver_runs, 1u);
  EXPECT_EQ(use_.eigen_pairs, 10u);
  const auto second = Get(cache, mesh, 10);
  EXPECT_EQ(use_.outcome, CacheOutcome::kHit);
  EXPECT_EQ(use_.solver_runs, 0u);
  EXPECT_EQ(use_.eigen_pairs, 10u);
  EXPECT_EQ(*first, *second);
  EXPECT_EQ(solver_->calls, 1);
  EXPECT_TRUE(cache.Contains(mesh, 10));
}

TEST_F(SpectrumCacheTest, AnotherMeshIsAMiss) {
  SpectrumCache cache(solver_, 1 << 20);
  ASSERT_TRUE(Get(cache, MeshNamed(1), 10).ok());
  ASSERT_TRUE(Get(cache, MeshNamed(2), 10).ok());
  EXPECT_EQ(solver_->calls, 2);
}

TEST_F(SpectrumCacheTest, FewerPairsAreAHitAndAreNoMore) {
  SpectrumCache cache(solver_, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1);
  ASSERT_TRUE(Get(cache, mesh, 10).ok());
  EXPECT_TRUE(cache.Contains(mesh, 9));
  const auto fewer = Get(cache, mesh, 9);
  EXPECT_EQ(use_.outcome, CacheOutcome::kHit);
  EXPECT_EQ(use_.solver_runs, 0u);
  EXPECT_EQ(use_.eigen_pairs, 9u);
  EXPECT_EQ((*fewer)->NumPairs(), 10u);
  EXPECT_EQ((*fewer)->eigenvectors.cols(), 10);
  EXPECT_EQ(solver_->calls, 1);
}

TEST_F(SpectrumCacheTest, MorePairsExtendTheEntry) {
  SpectrumCache cache(solver_, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1);
  ASSERT_TRUE(Get(cache, mesh, 10).ok());
  const uint64_t before = cache.bytes();
  EXPECT_FALSE(cache.Contains(mesh, 11));
  EXPECT_EQ((*Get(cache, mesh, 11))->NumPairs(), 12u);
  EXPECT_EQ(use_.outcome, CacheOutcome::kMiss);
  // One entry of 100 rows, a pair longer.
  EXPECT_EQ(cache.bytes(), before + sizeof(double) + 100 * sizeof(float));
  EXPECT_EQ((*Get(cache, mesh, 10))->NumPairs(), 11u);
  EXPECT_EQ(use_.outcome, CacheOutcome::kHit);
  EXPECT_EQ(solver_->calls, 2);
}

TEST_F(SpectrumCacheTest, WhatIsTooLongToBeKeptLeavesTheEntry) {
  SpectrumCache cache(solver_, 20'000);
  const CanonicalMesh mesh = MeshNamed(1);
  ASSERT_TRUE(Get(cache, mesh, 10).ok());
  EXPECT_EQ((*Get(cache, mesh, 90))->NumPairs(), 91u);
  EXPECT_FALSE(cache.Contains(mesh, 90));
  EXPECT_TRUE(cache.Contains(mesh, 10));
}

TEST_F(SpectrumCacheTest, PairsOfOneCountAloneAreForThatCount) {
  SpectrumCache cache(solver_, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1);
  solver_->for_any_count = false;
  ASSERT_TRUE(Get(cache, mesh, 10).ok());
  EXPECT_FALSE(cache.Contains(mesh, 9));
  EXPECT_TRUE(cache.Contains(mesh, 10));
  solver_->for_any_count = true;
  ASSERT_TRUE(Get(cache, mesh, 20).ok());
  solver_->gives_shared_pairs = false;
  EXPECT_FALSE(cache.Contains(mesh, 9));
  EXPECT_TRUE(cache.Contains(mesh, 10));
}

// Whatever the cache has, an answer is that of a solver without one.
TEST_F(SpectrumCacheTest, AnswersAreThoseOfAColdSolver) {
  auto solver = std::make_shared<SolverEigenPairSource>();
  // Sliced, dense, and sliced or dense as many pairs are wanted; a cluster.
  for (const TriangleMesh& shape :
       {LimbCross(4), Icosphere(2), Icosphere(3), Torus(2, 0.8, 48, 24)}) {
    const CanonicalMesh mesh = CanonicalOf(shape);
    SpectrumCache cache(solver, 1 << 30);
    for (uint32_t count : {60, 20, 100, 400, 13, 60, 500, 200}) {
      SCOPED_TRACE(count);
      const auto warm = *Get(cache, mesh, count);
      const auto cold = *solver->Get(mesh, count, never_, [](double) {});
      EXPECT_EQ(warm->NumPairs(), std::min(count + 1, mesh.mesh.NumVertices()));
      EXPECT_EQ(warm->eigenvalues, cold->eigenvalues);
      EXPECT_EQ(warm->eigenvectors, cold->eigenvectors);
      EXPECT_EQ(warm->complete, cold->complete);
      EXPECT_EQ(warm->area, cold->area);
      EXPECT_TRUE(cache.Contains(mesh, count));
    }
  }
}

// What ends before a cluster that is larger than what may be asked for.
TEST_F(SpectrumCacheTest, PairsThatEndBeforeAClusterAreKept) {
  SpectrumCache cache(std::make_shared<SolverEigenPairSource>(), 1 << 30);
  const CanonicalMesh mesh = CanonicalOf(Book(2'000, 1));
  const auto runs = [&](uint32_t count) {
    SpectrumUse use;
    const auto pairs = *cache.Open(mesh, count, use)->UpTo(0, never_, nullptr);
    EXPECT_EQ(pairs->NumPairs(), 1u);
    return use.solver_runs;
  };
  EXPECT_EQ(runs(60), 1u);
  EXPECT_EQ(runs(60), 0u);
  EXPECT_EQ(runs(50), 0u);
  EXPECT_EQ(runs(70), 1u);
  EXPECT_EQ(runs(70), 0u);
  EXPECT_EQ((*Get(cache, mesh, 50))->NumPairs(), 51u);
}

TEST_F(SpectrumCacheTest, AStreamIsGivenNoMoreThanItWasOpenedFor) {
  auto solver = std::make_shared<CountingStreams>();
  SpectrumCache cache(solver, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1);
  ASSERT_TRUE(Get(cache, mesh, 40).ok());
  const auto stream = cache.Open(mesh, 20);
  const auto pairs = *stream->UpTo(4, never_, nullptr);
  EXPECT_EQ(pairs->NumPairs(), 21u);
  EXPECT_EQ(*stream->UpTo(100, never_, nullptr), pairs);
  EXPECT_EQ(solver->extended, 1);
}

TEST_F(SpectrumCacheTest, CountsAboveTheMeshAreOneRequest) {
  SpectrumCache cache(solver_, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1, 8);
  ASSERT_TRUE(Get(cache, mesh, 7).ok());
  ASSERT_TRUE(Get(cache, mesh, 900).ok());
  EXPECT_EQ(use_.eigen_pairs, 7u);
  EXPECT_EQ(solver_->calls, 1);
}

TEST_F(SpectrumCacheTest, TheBudgetDropsWhatWasUsedLongestAgo) {
  // An entry of 10 pairs: 11 doubles and 1,100 floats, somewhat over 4,488
  // bytes.
  SpectrumCache cache(solver_, 11'000);
  ASSERT_TRUE(Get(cache, MeshNamed(1), 10).ok());
  ASSERT_TRUE(Get(cache, MeshNamed(2), 10).ok());
  ASSERT_TRUE(Get(cache, MeshNamed(1), 10).ok());
  ASSERT_TRUE(Get(cache, MeshNamed(3), 10).ok());
  EXPECT_LE(cache.bytes(), 11'000u);
  EXPECT_TRUE(cache.Contains(MeshNamed(1), 10));
  EXPECT_FALSE(cache.Contains(MeshNamed(2), 10));
  EXPECT_TRUE(cache.Contains(MeshNamed(3), 10));
}

TEST_F(SpectrumCacheTest, WhatIsLargerThanTheBudgetIsServedButNotKept) {
  SpectrumCache cache(solver_, 20'000);
  ASSERT_TRUE(Get(cache, MeshNamed(1), 10).ok());
  EXPECT_TRUE(Get(cache, MeshNamed(2), 90).ok());
  EXPECT_FALSE(cache.Contains(MeshNamed(2), 90));
  EXPECT_TRUE(cache.Contains(MeshNamed(1), 10));
}

TEST_F(SpectrumCacheTest, FailuresAreNotKept) {
  SpectrumCache cache(solver_, 1 << 20);
  solver_->fail = true;
  EXPECT_TRUE(absl::IsInternal(Get(cache, MeshNamed(1), 10).status()));
  solver_->fail = false;
  EXPECT_TRUE(Get(cache, MeshNamed(1), 10).ok());
  EXPECT_EQ(solver_->calls, 2);
}

TEST_F(SpectrumCacheTest, WhatAStreamFoundIsKeptAndGrows) {
  auto solver = std::make_shared<CountingStreams>();
  SpectrumCache cache(solver, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1);
  SpectrumUse use;
  const auto stream = cache.Open(mesh, 20, use);
  EXPECT_EQ((*stream->UpTo(4, never_, nullptr))->NumPairs(), 6u);
  EXPECT_EQ(use.outcome, CacheOutcome::kMiss);
  EXPECT_EQ(use.solver_runs, 1u);
  EXPECT_EQ((*stream->UpTo(3, never_, nullptr))->NumPairs(), 6u);
  EXPECT_EQ(solver->extended, 1);
  EXPECT_FALSE(cache.Contains(mesh, 20));

  // While the first stream is there, and not computing.
  SpectrumUse other;
  EXPECT_EQ(
      (*cache.Open(mesh, 20, other)->UpTo(4.5, never_, nullptr))->NumPairs(),
      6u);
  EXPECT_EQ(other.outcome, CacheOutcome::kHit);
  EXPECT_EQ(
      (*cache.Open(mesh, 20, other)->UpTo(9, never_, nullptr))->NumPairs(),
      11u);
  EXPECT_EQ(other.outcome, CacheOutcome::kMiss);
  EXPECT_EQ((*stream->UpTo(8, never_, nullptr))->NumPairs(), 11u);
  EXPECT_EQ(solver->extended, 2);

  EXPECT_EQ((*Get(cache, mesh, 20))->NumPairs(), 21u);
  EXPECT_TRUE(cache.Contains(mesh, 20));
  EXPECT_EQ((*stream->UpTo(100, never_, nullptr))->NumPairs(), 21u);
  EXPECT_EQ(solver->extended, 3);
  EXPECT_EQ(use.solver_runs, 1u);
}

TEST_F(SpectrumCacheTest, ACancelledStreamLeavesWhatItFound) {
  auto solver = std::make_shared<CountingStreams>();
  SpectrumCache cache(solver, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1);
  CancelToken cancel;
  const auto stream = cache.Open(mesh, 20);
  ASSERT_TRUE(stream->UpTo(4, cancel, nullptr).ok());
  cancel.Cancel();
  EXPECT_TRUE(absl::IsCancelled(stream->UpTo(9, cancel, nullptr).status()));
  const auto next = cache.Open(mesh, 20);
  EXPECT_EQ((*next->UpTo(4, never_, nullptr))->NumPairs(), 6u);
  EXPECT_EQ(solver->extended, 2);
  EXPECT_EQ((*next->UpTo(9, never_, nullptr))->NumPairs(), 11u);
}

// One caller on a thread of its own.
struct Caller {
  Caller(SpectrumCache& cache, const CanonicalMesh& mesh)
      : thread([this, &cache, &mesh] {
          result = cache.Get(
              mesh, 10, cancel,
              [this](double f) {
                EXPECT_GE(f, progress.load());
                progress = f;
              },
              use);
          done.Notify();
        }) {}
  ~Caller() { thread.join(); }

  CancelToken cancel;
  SpectrumUse use;
  std::atomic<double> progress{-1};
  absl::StatusOr<std::shared_ptr<const EigenPairs>> result;
  absl::Notification done;
  std::thread thread;
};

TEST_F(SpectrumCacheTest, ConcurrentCallersComputeOnce) {
  SpectrumCache cache(solver_, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1);
  solver_->hold = true;
  std::vector<std::unique_ptr<Caller>> callers;
  for (int i = 0; i < 8; ++i) {
    callers.push_back(std::make_unique<Caller>(cache, mesh));
  }
  for (const auto& caller : callers) {
    WaitUntil([&] { return caller->progress >= 0.5; });
  }
  solver_->hold = false;
  int misses = 0;
  for (const auto& caller : callers) {
    caller->done.WaitForNotification();
    EXPECT_TRUE(caller->result.ok());
    EXPECT_NE(caller->use.outcome, CacheOutcome::kHit);
    misses += caller->use.outcome == CacheOutcome::kMiss;
  }
  EXPECT_EQ(misses, 1);
  EXPECT_EQ(solver_->calls, 1);
}

TEST_F(SpectrumCacheTest, AWaiterTakesOverFromACancelledLeader) {
  SpectrumCache cache(solver_, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1);
  solver_->hold = true;
  Caller leader(cache, mesh);
  WaitUntil([&] { return solver_->calls == 1; });
  Caller waiter(cache, mesh);
  WaitUntil([&] { return waiter.progress >= 0.5; });
  leader.cancel.Cancel();
  WaitUntil([&] { return solver_->calls == 2; });
  solver_->hold = false;
  waiter.done.WaitForNotification();
  leader.done.WaitForNotification();
  EXPECT_TRUE(absl::IsCancelled(leader.result.status()));
  EXPECT_TRUE(waiter.result.ok());
  EXPECT_EQ(waiter.use.outcome, CacheOutcome::kMiss);
  EXPECT_EQ(waiter.use.solver_runs, 1u);
}

TEST_F(SpectrumCacheTest, ACancelledWaiterLeavesAtOnce) {
  SpectrumCache cache(solver_, 1 << 20);
  const CanonicalMesh mesh = MeshNamed(1);
  solver_->hold = true;
  Caller leader(cache, mesh);
  WaitUntil([&] { return solver_->calls == 1; });
  {
    Caller waiter(cache, mesh);
    WaitUntil([&] { return waiter.progress >= 0.5; });
    waiter.cancel.Cancel();
    EXPECT_TRUE(
        waiter.done.WaitForNotificationWithTimeout(absl::Milliseconds(500)));
    EXPECT_TRUE(absl::IsCancelled(waiter.result.status()));
  }
  EXPECT_FALSE(leader.done.HasBeenNotified());
  solver_->hold = false;
  leader.done.WaitForNotification();
  EXPECT_TRUE(leader.result.ok());
}

TEST_F(SpectrumCacheTest, ManyCallersUnderCancellationAllGetAnAnswer) {
  SpectrumCache cache(solver_, 30'000);
  std::vector<std::thread> threads;
  std::atomic<int> answered{0};
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 200; ++i) {
        CancelToken cancel;
        if ((i + t) % 5 == 0) cancel.Cancel();
        const auto result =
            cache.Get(MeshNamed((i * 7 + t) % 6), 10, cancel, [](double) {});
        answered += result.ok() || absl::IsCancelled(result.status());
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(answered, 1600);
  EXPECT_LE(cache.bytes(), 30'000u);
}

}  // namespace
}  // namespace marrow
