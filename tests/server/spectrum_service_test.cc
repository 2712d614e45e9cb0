#include "server/spectrum_service.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/base/crc32c.h"
#include "tests/server/service_fixture.h"

namespace marrow::testing {
namespace {

class SpectrumServiceTest : public ServiceTest {
 protected:
  std::vector<v1::SpectrumEvent> Compute(
      const v1::ComputeSpectrumRequest& request) {
    grpc::ClientContext context;
    auto reader = spectrum_->ComputeSpectrum(&context, request);
    std::vector<v1::SpectrumEvent> events;
    v1::SpectrumEvent event;
    uint64_t sequence = 0;
    while (reader->Read(&event)) {
      EXPECT_EQ(event.sequence(), ++sequence);
      if (!event.has_progress()) events.push_back(event);
    }
    status_ = reader->Finish();
    return events;
  }

  grpc::Status status_;
};

TEST_F(SpectrumServiceTest, PrewarmsTheCache) {
  Start();
  v1::ComputeSpectrumRequest request;
  request.mutable_mesh()->set_draco(StarPayload(3));
  request.set_eigen_pairs(20);
  const auto events = Compute(request);
  ASSERT_TRUE(status_.ok()) << status_.error_message();
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].header().pair_count(), 21u);
  EXPECT_EQ(events[0].header().report().vertices(), 642u);
  EXPECT_EQ(events[0].header().report().bodies(), 1u);
  EXPECT_EQ(events[1].eigenvalues().eigenvalues_size(), 21);
  EXPECT_EQ(events[1].eigenvalues().eigenvalues(0), 0);
  EXPECT_EQ(events[2].completed().spectrum().outcome(), v1::CACHE_OUTCOME_MISS);
  EXPECT_EQ(Segment(Request(StarPayload(3))).completed().spectrum().outcome(),
            v1::CACHE_OUTCOME_HIT);
  EXPECT_EQ(solver_->calls, 1);
}

TEST_F(SpectrumServiceTest, GivesAsManyPairsAsAreAskedForWhateverIsKept) {
  Start();
  v1::ComputeSpectrumRequest request;
  request.mutable_mesh()->set_draco(StarPayload(3));
  for (uint32_t pairs : {20u, 7u, 30u, 20u}) {
    request.set_eigen_pairs(pairs);
    const auto events = Compute(request);
    ASSERT_TRUE(status_.ok()) << status_.error_message();
    EXPECT_EQ(events[0].header().pair_count(), pairs + 1);
    EXPECT_EQ(events[1].eigenvalues().eigenvalues_size(), pairs + 1);
    const v1::SpectrumUse& use = events[2].completed().spectrum();
    EXPECT_EQ(use.eigen_pairs(), pairs);
    EXPECT_EQ(use.solver_runs(), use.outcome() == v1::CACHE_OUTCOME_MISS);
  }
  EXPECT_EQ(solver_->calls, 2);
}

TEST_F(SpectrumServiceTest, EigenvectorsComeOnDemand) {
  Start();
  v1::ComputeSpectrumRequest request;
  request.mutable_mesh()->set_draco(StarPayload(2));
  request.set_eigen_pairs(5);
  request.set_include_eigenvectors(true);
  const auto events = Compute(request);
  ASSERT_TRUE(status_.ok()) << status_.error_message();
  ASSERT_EQ(events.size(), 4u + 6u);
  EXPECT_EQ(events[2].certificate().residuals_size(), 6);
  const auto points = events[0].header().point_count();
  for (uint32_t pair = 0; pair < 6; ++pair) {
    const v1::EigenvectorChunk& chunk = events[3 + pair].eigenvector_chunk();
    EXPECT_EQ(chunk.pair(), pair);
    EXPECT_EQ(chunk.values().size(), points * sizeof(double));
    EXPECT_EQ(chunk.values_crc32c(), Crc32c(chunk.values()));
  }
}

TEST_F(SpectrumServiceTest, StrictPairsAreCertifiedAndLeaveTheCacheAlone) {
  Start();
  v1::ComputeSpectrumRequest request;
  request.mutable_mesh()->set_draco(StarPayload(3));
  request.set_eigen_pairs(20);
  request.set_strict(true);
  const auto events = Compute(request);
  ASSERT_TRUE(status_.ok()) << status_.error_message();
  ASSERT_EQ(events.size(), 4u);
  EXPECT_EQ(events[1].eigenvalues().eigenvalues_size(), 21);
  const v1::SpectrumCertificate& certificate = events[2].certificate();
  ASSERT_EQ(certificate.residuals_size(), 21);
  for (double residual : certificate.residuals()) EXPECT_LE(residual, 1e-8);
  uint32_t below = 0;
  for (double lambda : events[1].eigenvalues().eigenvalues())
    below += lambda < certificate.bound();
  EXPECT_EQ(certificate.count_below_bound(), below);
  EXPECT_GT(below, 10u);
  EXPECT_FALSE(events[3].completed().solver_revision().empty());
  EXPECT_EQ(events[3].completed().spectrum().eigen_pairs(), 20u);
  EXPECT_EQ(solver_->calls, 0);
  request.set_strict(false);
  EXPECT_EQ(Compute(request).back().completed().spectrum().outcome(),
            v1::CACHE_OUTCOME_MISS);
}

TEST_F(SpectrumServiceTest, BadFieldsAreNamed) {
  Start();
  v1::ComputeSpectrumRequest request;
  request.set_eigen_pairs(1001);
  EXPECT_TRUE(Compute(request).empty());
  EXPECT_EQ(ReasonIn(status_), "INVALID_PARAMETER eigen_pairs");
  request.clear_eigen_pairs();
  Compute(request);
  EXPECT_EQ(ReasonIn(status_), "INVALID_PARAMETER mesh");
}

}  // namespace
}  // namespace marrow::testing
