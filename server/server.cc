#include "server/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/status_macros.h"
#include "grpc/health/v1/health.pb.h"
#include "server/capabilities_service.h"
#include "server/engine.h"
#include "server/mesh_store_service.h"
#include "server/segmentation_service.h"
#include "server/service_context.h"
#include "server/spectrum_service.h"

namespace marrow {
namespace {

constexpr int kReceiveLimit = 2 << 20;
constexpr uint64_t kMaxInlineBytes = 1 << 20;
constexpr int kMaxStreams = 100;
constexpr int kMinPingIntervalMs = 10'000;
constexpr int kMaxMetadataBytes = 8 << 10;

absl::Status ValidateServerOptions(const ServerOptions& options) {
  if (options.max_inline_mesh_bytes > kMaxInlineBytes) {
    return absl::InvalidArgumentError(
        "max_inline_mesh_bytes must be at most 1 MiB");
  }
  if (options.mesh_limits.max_bytes < 1 || options.mesh_limits.max_faces < 1 ||
      options.mesh_limits.max_vertices < 3) {
    return absl::InvalidArgumentError(
        "the mesh limits must allow a byte, a face and three vertices at "
        "least");
  }
  if (options.mesh_store_bytes < options.mesh_limits.max_bytes) {
    return absl::InvalidArgumentError(absl::StrCat(
        "a mesh store of ", options.mesh_store_bytes,
        " bytes cannot hold a mesh of the greatest size, ",
        options.mesh_limits.max_bytes,
        " bytes; raise --mesh-store-bytes or lower --max-mesh-bytes"));
  }
  if (options.compute_threads < 0 || options.compute_threads > 1024 ||
      options.max_queued_jobs < 0) {
    return absl::InvalidArgumentError(
        "the number of threads must be 0 to 1024 and that of waiting calls 0 "
        "or more");
  }
  return absl::OkStatus();
}

// Linking gRPC's reflection library switches it on for every server of the
// process; this leaves it to one server, or takes it from it.
class ReflectionOption final : public grpc::ServerBuilderOption {
 public:
  explicit ReflectionOption(bool wanted) : wanted_(wanted) {}

  void UpdateArguments(grpc::ChannelArguments*) override {}
  void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>*
                         plugins) override {
    auto ours =
        std::make_unique<grpc::reflection::ProtoServerReflectionPlugin>();
    std::erase_if(*plugins, [&ours](const auto& plugin) {
      return plugin->name() == ours->name();
    });
    if (!wanted_) return;
    plugins->push_back(std::move(ours));
    // gRPC's own health service comes without a descriptor, and tools that meet
    // a service without one give up on all; this links it in.
    grpc::health::v1::HealthCheckRequest::descriptor();
  }

 private:
  const bool wanted_;
};

void SetArguments(const ServerOptions& options, grpc::ServerBuilder& builder) {
  builder.SetMaxReceiveMessageSize(kReceiveLimit);
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxStreams);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(
      GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
      kMinPingIntervalMs);
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMaxMetadataBytes);
  builder.SetOption(std::make_unique<ReflectionOption>(options.reflection));
}

class ServerImpl final : public Server {
 public:
  ServerImpl(const ServerOptions& options, Engine engine)
      : context_(options, std::move(engine)),
        segmentation_(context_),
        mesh_store_(context_),
        spectrum_(context_),
        capabilities_(context_) {}

  ~ServerImpl() override {
    if (server_ != nullptr) Drain(std::chrono::milliseconds(0));
  }

  absl::Status Listen() {
    grpc::EnableDefaultHealthCheckService(true);
    grpc::ServerBuilder builder;
    SetArguments(context_.options, builder);
    const std::string& address = context_.options.listen;
    if (!address.empty()) {
      builder.AddListeningPort(address, grpc::InsecureServerCredentials(),
                               &port_);
    }
    builder.RegisterService(&segmentation_);
    builder.RegisterService(&mesh_store_);
    builder.RegisterService(&spectrum_);
    builder.RegisterService(&capabilities_);
    server_ = builder.BuildAndStart();
    if (server_ == nullptr || (!address.empty() && port_ <= 0)) {
      return absl::UnavailableError(absl::StrCat(
          "cannot listen on ", address,
          ": the port is taken, or the host is unknown or not this machine"));
    }
    SetServing(true);
    return absl::OkStatus();
  }

  int port() const override { return port_; }

  std::shared_ptr<grpc::Channel> InProcessChannel() override {
    return server_->InProcessChannel(grpc::ChannelArguments());
  }

  void Drain(std::chrono::milliseconds grace) override {
    absl::MutexLock lock(&drain_mu_);
    if (drained_) return;
    context_.draining = true;
    SetServing(false);
    context_.calls.WaitForNone(grace);
    server_->Shutdown(std::chrono::system_clock::now());
    server_->Wait();
    // gRPC may have let go of a call whose state another thread still drops.
    context_.calls.WaitForNone(std::chrono::hours(1));
    drained_ = true;
  }

 private:
  void SetServing(bool serving) {
    grpc::HealthCheckServiceInterface* health =
        server_->GetHealthCheckService();
    for (const char* service : {v1::SegmentationService::service_full_name(),
                                v1::MeshStoreService::service_full_name(),
                                v1::SpectrumService::service_full_name(),
                                v1::CapabilitiesService::service_full_name()}) {
      health->SetServingStatus(service, serving);
    }
    health->SetServingStatus(serving);
  }

  ServiceContext context_;
  SegmentationService segmentation_;
  MeshStoreService mesh_store_;
  SpectrumService spectrum_;
  CapabilitiesService capabilities_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
  absl::Mutex drain_mu_;
  bool drained_ ABSL_GUARDED_BY(drain_mu_) = false;
};

}  // namespace

absl::StatusOr<std::unique_ptr<Server>> Server::Start(
    const ServerOptions& options) {
  return Start(options, Engine());
}

absl::StatusOr<std::unique_ptr<Server>> Server::Start(
    const ServerOptions& options, Engine engine) {
  MARROW_RETURN_IF_ERROR(ValidateServerOptions(options));
  auto server = std::make_unique<ServerImpl>(options, std::move(engine));
  MARROW_RETURN_IF_ERROR(server->Listen());
  return std::unique_ptr<Server>(std::move(server));
}

}  // namespace marrow
