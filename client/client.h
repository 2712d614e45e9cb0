// The client of Marrow's services.
#ifndef MARROW_CLIENT_CLIENT_H_
#define MARROW_CLIENT_CLIENT_H_

#include <grpcpp/grpcpp.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/call_group.h"
#include "client/payload.h"
#include "client/segmentation.h"
#include "marrow/v1/capabilities_service.grpc.pb.h"
#include "marrow/v1/mesh_store_service.grpc.pb.h"
#include "marrow/v1/segmentation_service.grpc.pb.h"
#include "marrow/v1/spectrum_service.grpc.pb.h"

namespace marrow::client {

// The answer to one ComputeSpectrum call.
struct Spectrum {
  std::vector<double> eigenvalues;  // ascending, the constant pair's 0 first
  // eigenvectors[k * num_points + p]: pair k at point p of the payload. Empty
  // where they were not asked for.
  std::vector<double> eigenvectors;
  uint32_t num_points = 0;
  // One a pair, and the certificate, as SpectrumCertificate has them; no
  // residuals where none was asked for.
  std::vector<double> residuals;
  double bound = 0;
  uint32_t count_below_bound = 0;
  std::string solver_revision;
  nlohmann::json report;
  nlohmann::json timings;
  nlohmann::json cache;
};

// Receives the events of a call, in order, on the thread that called.
using SegmentObserver = std::function<void(const v1::SegmentEvent&)>;

// Thread safe. Failed calls have the server's code and message, and its reason
// and field for ReasonOf() and FieldOf() (core/base/error_reason.h). A server
// that does not answer at all gives UNAVAILABLE without a reason, an answer
// that contradicts itself DATA_LOSS.
//
// A call is one round trip where the mesh is small enough to go inline, or the
// server has it: larger ones are named by digest first, and uploaded only where
// the server lacks them.
class Client {
 public:
  // Connects, or fails with UNAVAILABLE within `patience`. The address is
  // HOST:PORT or what else gRPC takes.
  static absl::StatusOr<std::unique_ptr<Client>> Connect(
      const std::string& address, absl::Duration patience);

  // Talks over a channel that is there. Whatever serves it must outlive the
  // client.
  explicit Client(std::shared_ptr<grpc::Channel> channel);

  // `timeout` bounds each function as a whole, uploads included.
  // Labels are those of the payload's faces and points as it decodes. Reports
  // and warnings tell of unused vertices that were not sent, too. Of
  // `parameters`, options and cut are heeded; mesh and outputs are set by the
  // call.
  absl::StatusOr<Segmentation> Segment(const Payload& payload,
                                       const v1::SegmentRequest& parameters,
                                       absl::Duration timeout,
                                       const SegmentObserver& observer);
  // Another cut of what was segmented with the same options; nothing is
  // uploaded. Of `parameters`, options and cut are heeded. NOT_FOUND, reason
  // NOT_CACHED, where the server does not have it any more.
  absl::StatusOr<CutAnswer> Cut(const Payload& payload,
                                const v1::CutRequest& parameters,
                                absl::Duration timeout);
  absl::StatusOr<v1::InspectMeshResponse> Inspect(const Payload& payload,
                                                  absl::Duration timeout);
  // The mesh of `parameters` is set by the call.
  absl::StatusOr<Spectrum> ComputeSpectrum(
      const Payload& payload, const v1::ComputeSpectrumRequest& parameters,
      absl::Duration timeout,
      const std::function<void(const v1::Progress&)>& observer);
  absl::StatusOr<v1::GetCapabilitiesResponse> GetCapabilities(
      absl::Duration timeout);
  // OK where the server says SERVING.
  absl::Status CheckHealth(absl::Duration timeout);

  // Ends what runs with CANCELLED, and every later call at once.
  void Cancel() { calls_.Cancel(); }

 private:
  // Sends a request whose mesh is `source`.
  using Attempt =
      std::function<absl::Status(const v1::MeshSource&, absl::Time deadline)>;

  // Calls `attempt` with the mesh inline or by digest, uploading where needed.
  absl::Status WithMesh(const Payload& payload, absl::Time deadline,
                        const Attempt& attempt);
  absl::Status Upload(const Payload& payload, const v1::MeshDigest& digest,
                      absl::Time deadline);

  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::SegmentationService::Stub> segmentation_;
  std::unique_ptr<v1::MeshStoreService::Stub> store_;
  std::unique_ptr<v1::SpectrumService::Stub> spectrum_;
  std::unique_ptr<v1::CapabilitiesService::Stub> capabilities_;
  CallGroup calls_;
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_CLIENT_H_
