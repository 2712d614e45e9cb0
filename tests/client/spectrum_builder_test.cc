#include "client/spectrum_builder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "core/base/crc32c.h"

namespace marrow::client {
namespace {

using Events = std::vector<v1::SpectrumEvent>;

// Two pairs of three points, with all that can be asked for.
Events GoodAnswer() {
  Events events(6);
  events[0].mutable_header()->set_pair_count(2);
  events[0].mutable_header()->set_point_count(3);
  for (double lambda : {0.0, 5.0})
    events[1].mutable_eigenvalues()->add_eigenvalues(lambda);
  v1::SpectrumCertificate* certificate = events[2].mutable_certificate();
  for (double residual : {0.0, 1e-9}) certificate->add_residuals(residual);
  certificate->set_bound(6);
  certificate->set_count_below_bound(2);
  for (uint32_t pair : {0, 1}) {
    v1::EigenvectorChunk* chunk = events[3 + pair].mutable_eigenvector_chunk();
    const double values[] = {1, 2, 3.0 + pair};
    chunk->set_pair(pair);
    chunk->mutable_values()->assign(reinterpret_cast<const char*>(values),
                                    sizeof(values));
    chunk->set_values_crc32c(Crc32c(chunk->values()));
  }
  events[5].mutable_completed()->set_solver_revision("solver/1");
  return events;
}

v1::ComputeSpectrumRequest AskFor(bool eigenvectors, bool strict) {
  v1::ComputeSpectrumRequest request;
  request.set_include_eigenvectors(eigenvectors);
  request.set_strict(strict);
  return request;
}

absl::StatusOr<Spectrum> Build(const v1::ComputeSpectrumRequest& request,
                               Events events) {
  SpectrumBuilder builder(3, request);
  uint64_t sequence = 0;
  for (v1::SpectrumEvent& event : events) {
    event.set_sequence(++sequence);
    const absl::Status status = builder.Add(event);
    if (!status.ok()) return status;
  }
  return builder.Finish();
}

TEST(SpectrumBuilderTest, TakesAWholeAnswer) {
  const auto spectrum = Build(AskFor(true, false), GoodAnswer());
  ASSERT_TRUE(spectrum.ok()) << spectrum.status();
  EXPECT_EQ(spectrum->eigenvalues, (std::vector<double>{0, 5}));
  EXPECT_EQ(spectrum->eigenvectors, (std::vector<double>{1, 2, 3, 1, 2, 4}));
  EXPECT_EQ(spectrum->residuals, (std::vector<double>{0, 1e-9}));
  EXPECT_EQ(spectrum->bound, 6);
  EXPECT_EQ(spectrum->count_below_bound, 2u);
  EXPECT_EQ(spectrum->solver_revision, "solver/1");
}

TEST(SpectrumBuilderTest, TakesACertificateWithoutEigenvectors) {
  Events events = GoodAnswer();
  events.erase(events.begin() + 3, events.begin() + 5);
  EXPECT_TRUE(Build(AskFor(false, true), events).ok());
}

TEST(SpectrumBuilderTest, RefusesAnswersThatContradictThemselves) {
  const std::vector<std::function<void(Events&)>> damages = {
      [](Events& e) { e.erase(e.begin() + 2); },
      [](Events& e) { e[2].mutable_certificate()->add_residuals(0); },
      [](Events& e) { e[2].mutable_certificate()->set_count_below_bound(3); },
      [](Events& e) { e.erase(e.begin() + 4); },
      [](Events& e) { e[3].mutable_eigenvector_chunk()->set_pair(1); },
      [](Events& e) { e[3].mutable_eigenvector_chunk()->set_values_crc32c(1); },
      [](Events& e) { e[0].mutable_header()->set_point_count(4); },
      [](Events& e) { e[1].mutable_eigenvalues()->add_eigenvalues(9); },
      [](Events& e) { e.pop_back(); },
  };
  for (size_t i = 0; i < damages.size(); ++i) {
    Events events = GoodAnswer();
    damages[i](events);
    EXPECT_TRUE(absl::IsDataLoss(Build(AskFor(true, false), events).status()))
        << i;
  }
}

TEST(SpectrumBuilderTest, RefusesWhatWasNotAskedFor) {
  EXPECT_TRUE(
      absl::IsDataLoss(Build(AskFor(false, false), GoodAnswer()).status()));
  EXPECT_TRUE(
      absl::IsDataLoss(Build(AskFor(false, true), GoodAnswer()).status()));
}

}  // namespace
}  // namespace marrow::client
