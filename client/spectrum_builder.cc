#include "client/spectrum_builder.h"

#include <bit>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/message_json.h"
#include "core/base/crc32c.h"

namespace marrow::client {
namespace {

// More than any server may give (2 to 1000 besides the constant one).
constexpr uint32_t kMaxPairs = 100'000;

template <typename... Args>
absl::Status Bad(const Args&... args) {
  return absl::DataLossError(
      absl::StrCat("the server's answer is broken: ", args...));
}

double UnpackDouble(const char* bytes) {
  uint64_t bits = 0;
  for (size_t b = 0; b < sizeof(bits); ++b) {
    bits |= uint64_t{static_cast<unsigned char>(bytes[b])} << (8 * b);
  }
  return std::bit_cast<double>(bits);
}

}  // namespace

absl::Status SpectrumBuilder::Add(const v1::SpectrumEvent& event) {
  if (event.sequence() != ++sequence_ || completed_) {
    return Bad("event ", event.sequence(), " came in place of ", sequence_);
  }
  switch (event.event_case()) {
    case v1::SpectrumEvent::kHeader:
      return AddHeader(event.header());
    case v1::SpectrumEvent::kEigenvalues:
      return AddEigenvalues(event.eigenvalues());
    case v1::SpectrumEvent::kCertificate:
      return AddCertificate(event.certificate());
    case v1::SpectrumEvent::kEigenvectorChunk:
      return AddChunk(event.eigenvector_chunk());
    case v1::SpectrumEvent::kCompleted:
      completed_ = true;
      spectrum_.timings = TimingsJson(event.completed().timings());
      spectrum_.cache = CacheJson(event.completed().spectrum());
      spectrum_.solver_revision = event.completed().solver_revision();
      return absl::OkStatus();
    default:
      return absl::OkStatus();
  }
}

absl::Status SpectrumBuilder::AddHeader(const v1::SpectrumHeader& header) {
  if (header.point_count() != spectrum_.num_points ||
      header.pair_count() > kMaxPairs) {
    return Bad("it has ", header.pair_count(), " pairs of ",
               header.point_count(), " points for ", spectrum_.num_points);
  }
  pair_count_ = header.pair_count();
  spectrum_.report = ReportJson(header.report());
  return absl::OkStatus();
}

absl::Status SpectrumBuilder::AddEigenvalues(
    const v1::Eigenvalues& eigenvalues) {
  if (static_cast<uint32_t>(eigenvalues.eigenvalues_size()) != pair_count_) {
    return Bad("it has ", eigenvalues.eigenvalues_size(), " eigenvalues for ",
               pair_count_, " pairs");
  }
  spectrum_.eigenvalues.assign(eigenvalues.eigenvalues().begin(),
                               eigenvalues.eigenvalues().end());
  return absl::OkStatus();
}

absl::Status SpectrumBuilder::AddCertificate(
    const v1::SpectrumCertificate& certificate) {
  if (!with_certificate_ ||
      static_cast<uint32_t>(certificate.residuals_size()) != pair_count_ ||
      certificate.count_below_bound() > pair_count_) {
    return Bad("it has ", certificate.residuals_size(),
               " residuals and counts ", certificate.count_below_bound(),
               " of ", pair_count_, " pairs");
  }
  spectrum_.residuals.assign(certificate.residuals().begin(),
                             certificate.residuals().end());
  spectrum_.bound = certificate.bound();
  spectrum_.count_below_bound = certificate.count_below_bound();
  return absl::OkStatus();
}

absl::Status SpectrumBuilder::AddChunk(const v1::EigenvectorChunk& chunk) {
  const std::string& bytes = chunk.values();
  const size_t count = bytes.size() / sizeof(double);
  const size_t first =
      size_t{chunk.pair()} * spectrum_.num_points + chunk.first_point();
  if (!with_eigenvectors_ || chunk.pair() >= pair_count_ ||
      bytes.size() % sizeof(double) != 0 ||
      chunk.first_point() > spectrum_.num_points ||
      first != spectrum_.eigenvectors.size() ||
      count > spectrum_.num_points - chunk.first_point()) {
    return Bad("a run of eigenvector ", chunk.pair(), " does not fit at ",
               chunk.first_point());
  }
  if (Crc32c(bytes) != chunk.values_crc32c()) {
    return Bad("the checksum of a run of eigenvectors does not match");
  }
  for (size_t i = 0; i < count; ++i) {
    spectrum_.eigenvectors.push_back(
        UnpackDouble(bytes.data() + i * sizeof(double)));
  }
  return absl::OkStatus();
}

absl::StatusOr<Spectrum> SpectrumBuilder::Finish() {
  const size_t values = size_t{pair_count_} * spectrum_.num_points;
  if (!completed_ || spectrum_.eigenvalues.size() != pair_count_ ||
      (with_certificate_ && spectrum_.residuals.size() != pair_count_) ||
      (with_eigenvectors_ && spectrum_.eigenvectors.size() != values)) {
    return Bad("it is not whole");
  }
  return std::move(spectrum_);
}

}  // namespace marrow::client
