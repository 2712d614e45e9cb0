#include "client/client.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "client/answer_builder.h"
#include "client/rpc_status.h"
#include "client/spectrum_builder.h"
#include "client/unused_vertices.h"
#include "core/base/crc32c.h"
#include "core/base/digest.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "grpc/health/v1/health.grpc.pb.h"

namespace marrow::client {
namespace {

// What servers take inline, unless they say less. To ask them first would be a
// round trip more for every command.
constexpr size_t kMaxInlineBytes = 1 << 20;
constexpr size_t kUploadChunk = 256 << 10;
// A mesh that was just uploaded may be evicted by others' uploads before it is
// named; more than twice means that the store is too small for it.
constexpr int kMaxUploads = 2;
constexpr int kMaxReceiveBytes = 8 << 20;

grpc::ChannelArguments ChannelArguments() {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(kMaxReceiveBytes);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 30'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 20'000);
  return arguments;
}

v1::MeshDigest DigestOf(const std::string& bytes) {
  const Digest digest = Sha256(bytes);
  v1::MeshDigest result;
  result.set_sha256(digest.bytes.data(), digest.bytes.size());
  result.set_size_bytes(bytes.size());
  return result;
}

v1::OutputSelection AllLabels() {
  v1::OutputSelection outputs;
  outputs.add_label_domains(v1::LABEL_DOMAIN_FACE);
  outputs.add_label_domains(v1::LABEL_DOMAIN_VERTEX);
  return outputs;
}

// Reads a stream to its end. What the client itself finds wrong comes before
// the status with which the call then ends.
template <typename Event, typename Take>
absl::Status ReadAll(CallGroup::Context& context,
                     grpc::ClientReader<Event>& reader, const Take& take) {
  Event event;
  while (reader.Read(&event)) {
    if (absl::Status status = take(event); !status.ok()) {
      context.get()->TryCancel();
      reader.Finish();
      return status;
    }
  }
  return FromRpcStatus(reader.Finish());
}

// Completes a report on the mesh, and warns as the server would have.
absl::Status TakeSegmentEvent(const Payload& payload,
                              const SegmentObserver& observer,
                              v1::SegmentEvent& event, AnswerBuilder& builder) {
  const bool was_short = event.has_mesh_report() &&
                         CountUnusedVertices(payload.num_unused_vertices,
                                             *event.mutable_mesh_report());
  MARROW_RETURN_IF_ERROR(builder.Add(event));
  observer(event);
  if (!was_short) return absl::OkStatus();
  v1::SegmentEvent warned;
  *warned.mutable_warning() =
      UnusedVerticesWarning(payload.num_unused_vertices);
  builder.AddWarning(warned.warning());
  observer(warned);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Client>> Client::Connect(
    const std::string& address, absl::Duration patience) {
  std::shared_ptr<grpc::Channel> channel = grpc::CreateCustomChannel(
      address, grpc::InsecureChannelCredentials(), ChannelArguments());
  if (!channel->WaitForConnected(absl::ToChronoTime(absl::Now() + patience))) {
    return absl::UnavailableError(absl::StrCat(
        "cannot reach a server at ", address, " (waited ",
        absl::FormatDuration(absl::Trunc(patience + absl::Milliseconds(50),
                                         absl::Milliseconds(100))),
        "): start marrowd there, correct --server or MARROW_SERVER, or leave "
        "both out to compute in this process"));
  }
  return std::make_unique<Client>(std::move(channel));
}

Client::Client(std::shared_ptr<grpc::Channel> channel)
    : channel_(std::move(channel)),
      segmentation_(v1::SegmentationService::NewStub(channel_)),
      store_(v1::MeshStoreService::NewStub(channel_)),
      spectrum_(v1::SpectrumService::NewStub(channel_)),
      capabilities_(v1::CapabilitiesService::NewStub(channel_)) {}

absl::StatusOr<Segmentation> Client::Segment(
    const Payload& payload, const v1::SegmentRequest& parameters,
    absl::Duration timeout, const SegmentObserver& observer) {
  v1::SegmentRequest request = parameters;
  *request.mutable_outputs() = AllLabels();
  std::unique_ptr<AnswerBuilder> builder;
  const Attempt attempt = [&](const v1::MeshSource& source,
                              absl::Time deadline) {
    *request.mutable_mesh() = source;
    builder =
        std::make_unique<AnswerBuilder>(payload.num_faces, payload.num_points);
    CallGroup::Context context(calls_, deadline);
    auto reader = segmentation_->Segment(context.get(), request);
    return ReadAll(context, *reader, [&](v1::SegmentEvent& event) {
      return TakeSegmentEvent(payload, observer, event, *builder);
    });
  };
  MARROW_RETURN_IF_ERROR(WithMesh(payload, absl::Now() + timeout, attempt));
  MARROW_ASSIGN_OR_RETURN(Segmentation answer, builder->Finish());
  if (request.has_cut() && !answer.cut.has_value()) {
    return BrokenAnswer("it lacks the cut that was asked for");
  }
  return answer;
}

absl::StatusOr<CutAnswer> Client::Cut(const Payload& payload,
                                      const v1::CutRequest& parameters,
                                      absl::Duration timeout) {
  v1::CutRequest request = parameters;
  *request.mutable_outputs() = AllLabels();
  *request.mutable_mesh_digest() = DigestOf(payload.draco);
  AnswerBuilder builder(payload.num_faces, payload.num_points);
  CallGroup::Context context(calls_, absl::Now() + timeout);
  auto reader = segmentation_->Cut(context.get(), request);
  MARROW_RETURN_IF_ERROR(ReadAll(
      context, *reader,
      [&](const v1::SegmentEvent& event) { return builder.Add(event); }));
  return builder.FinishCut();
}

absl::StatusOr<v1::InspectMeshResponse> Client::Inspect(
    const Payload& payload, absl::Duration timeout) {
  v1::InspectMeshResponse response;
  const Attempt attempt = [&](const v1::MeshSource& source,
                              absl::Time deadline) {
    v1::InspectMeshRequest request;
    *request.mutable_mesh() = source;
    CallGroup::Context context(calls_, deadline);
    return FromRpcStatus(
        store_->InspectMesh(context.get(), request, &response));
  };
  MARROW_RETURN_IF_ERROR(WithMesh(payload, absl::Now() + timeout, attempt));
  CountUnusedVertices(payload.num_unused_vertices, *response.mutable_report());
  return response;
}

absl::StatusOr<Spectrum> Client::ComputeSpectrum(
    const Payload& payload, const v1::ComputeSpectrumRequest& parameters,
    absl::Duration timeout,
    const std::function<void(const v1::Progress&)>& observer) {
  v1::ComputeSpectrumRequest request = parameters;
  std::unique_ptr<SpectrumBuilder> builder;
  const Attempt attempt = [&](const v1::MeshSource& source,
                              absl::Time deadline) {
    *request.mutable_mesh() = source;
    builder = std::make_unique<SpectrumBuilder>(payload.num_points, parameters);
    CallGroup::Context context(calls_, deadline);
    auto reader = spectrum_->ComputeSpectrum(context.get(), request);
    return ReadAll(context, *reader, [&](v1::SpectrumEvent& event) {
      if (event.has_progress()) observer(event.progress());
      if (event.has_header()) {
        CountUnusedVertices(payload.num_unused_vertices,
                            *event.mutable_header()->mutable_report());
      }
      return builder->Add(event);
    });
  };
  MARROW_RETURN_IF_ERROR(WithMesh(payload, absl::Now() + timeout, attempt));
  return builder->Finish();
}

absl::StatusOr<v1::GetCapabilitiesResponse> Client::GetCapabilities(
    absl::Duration timeout) {
  CallGroup::Context context(calls_, absl::Now() + timeout);
  v1::GetCapabilitiesResponse response;
  MARROW_RETURN_IF_ERROR(FromRpcStatus(
      capabilities_->GetCapabilities(context.get(), {}, &response)));
  return response;
}

absl::Status Client::CheckHealth(absl::Duration timeout) {
  CallGroup::Context context(calls_, absl::Now() + timeout);
  grpc::health::v1::HealthCheckResponse response;
  MARROW_RETURN_IF_ERROR(
      FromRpcStatus(grpc::health::v1::Health::NewStub(channel_)->Check(
          context.get(), {}, &response)));
  return response.status() == grpc::health::v1::HealthCheckResponse::SERVING
             ? absl::OkStatus()
             : absl::UnavailableError(
                   "the server is not serving: it starts, "
                   "or it is about to stop");
}

absl::Status Client::WithMesh(const Payload& payload, absl::Time deadline,
                              const Attempt& attempt) {
  v1::MeshSource source;
  if (payload.draco.size() <= kMaxInlineBytes) {
    source.set_draco(payload.draco);
    absl::Status status = attempt(source, deadline);
    if (FieldOf(status) != "mesh.draco") return status;
  }
  *source.mutable_digest() = DigestOf(payload.draco);
  absl::Status status = attempt(source, deadline);
  for (int i = 0; i < kMaxUploads && ReasonOf(status) == kReasonMeshMissing;
       ++i) {
    MARROW_RETURN_IF_ERROR(Upload(payload, source.digest(), deadline));
    status = attempt(source, deadline);
  }
  return status;
}

absl::Status Client::Upload(const Payload& payload,
                            const v1::MeshDigest& digest, absl::Time deadline) {
  CallGroup::Context context(calls_, deadline);
  v1::UploadMeshResponse response;
  auto writer = store_->UploadMesh(context.get(), &response);
  v1::UploadMeshRequest request;
  *request.mutable_header() = digest;
  bool open = writer->Write(request);
  // A server that has the mesh already, or refuses it, closes the stream early;
  // Finish() tells which.
  for (size_t offset = 0; open && offset < payload.draco.size();
       offset += kUploadChunk) {
    v1::UploadMeshRequest::Chunk& chunk = *request.mutable_chunk();
    chunk.set_offset(offset);
    chunk.set_data(payload.draco.substr(offset, kUploadChunk));
    chunk.set_data_crc32c(Crc32c(chunk.data()));
    open = writer->Write(request);
  }
  writer->WritesDone();
  return FromRpcStatus(writer->Finish());
}

}  // namespace marrow::client
