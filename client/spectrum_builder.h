// The events of one ComputeSpectrum call -> a Spectrum.
#ifndef MARROW_CLIENT_SPECTRUM_BUILDER_H_
#define MARROW_CLIENT_SPECTRUM_BUILDER_H_

#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/client.h"
#include "marrow/v1/spectrum_service.pb.h"

namespace marrow::client {

// Trusts nothing that a server says. Not thread safe. Errors: DATA_LOSS.
class SpectrumBuilder {
 public:
  // `request` is what was asked for, of a mesh with `num_points` points.
  SpectrumBuilder(uint32_t num_points,
                  const v1::ComputeSpectrumRequest& request)
      : with_eigenvectors_(request.include_eigenvectors()),
        with_certificate_(request.include_eigenvectors() || request.strict()) {
    spectrum_.num_points = num_points;
  }

  // Takes the next event of the stream.
  absl::Status Add(const v1::SpectrumEvent& event);
  // Call once, after the stream ended well.
  absl::StatusOr<Spectrum> Finish();

 private:
  absl::Status AddHeader(const v1::SpectrumHeader& header);
  absl::Status AddEigenvalues(const v1::Eigenvalues& eigenvalues);
  absl::Status AddCertificate(const v1::SpectrumCertificate& certificate);
  absl::Status AddChunk(const v1::EigenvectorChunk& chunk);

  const bool with_eigenvectors_;
  const bool with_certificate_;
  uint64_t sequence_ = 0;
  uint32_t pair_count_ = 0;
  bool completed_ = false;
  Spectrum spectrum_;
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_SPECTRUM_BUILDER_H_
