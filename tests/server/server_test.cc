#include "server/server.h"

#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/boundaries/calibration.h"
#include "marrow/v1/capabilities_service.grpc.pb.h"
#include "tests/server/service_fixture.h"

namespace marrow::testing {
namespace {

// Calls a method whose messages are not compiled in: bytes to bytes.
std::pair<grpc::Status, std::string> RawCall(
    const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
    const std::string& request) {
  grpc::GenericStub stub(channel);
  grpc::CompletionQueue queue;
  grpc::ClientContext context;
  const auto next = [&queue] {
    void* tag = nullptr;
    bool ok = false;
    queue.Next(&tag, &ok);
    return ok;
  };
  auto call = stub.PrepareCall(&context, method, &queue);
  call->StartCall(nullptr);
  next();
  const grpc::Slice slice(request);
  call->Write(grpc::ByteBuffer(&slice, 1), nullptr);
  next();
  call->WritesDone(nullptr);
  next();
  grpc::ByteBuffer response;
  call->Read(&response, nullptr);
  std::string bytes;
  grpc::Slice joined;
  if (next() && response.DumpToSingleSlice(&joined).ok()) {
    bytes.assign(reinterpret_cast<const char*>(joined.begin()), joined.size());
  }
  grpc::Status status;
  call->Finish(&status, nullptr);
  next();
  return {status, bytes};
}

// HealthCheckRequest has the service as field 1, the answer its status.
std::string Health(const std::shared_ptr<grpc::Channel>& channel,
                   const std::string& service) {
  std::string request = "\x0a";
  request += static_cast<char>(service.size());
  const auto [status, bytes] =
      RawCall(channel, "/grpc.health.v1.Health/Check", request + service);
  if (!status.ok()) return "error";
  return bytes == "\x08\x01" ? "SERVING" : "NOT_SERVING";
}

std::pair<grpc::Status, std::string> Reflect(
    const std::shared_ptr<grpc::Channel>& channel, const std::string& request) {
  return RawCall(
      channel, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo",
      request);
}

// ServerReflectionRequest has list_services as field 7.
std::pair<grpc::Status, std::string> ListServices(
    const std::shared_ptr<grpc::Channel>& channel) {
  return Reflect(channel, std::string("\x3a\x00", 2));
}

// And file_containing_symbol as field 4.
std::string FileOf(const std::shared_ptr<grpc::Channel>& channel,
                   const std::string& symbol) {
  std::string request = "\x22";
  request += static_cast<char>(symbol.size());
  return Reflect(channel, request + symbol).second;
}

class ServerTest : public ServiceTest {};

TEST_F(ServerTest, HealthKnowsEveryService) {
  Start();
  for (const char* service :
       {"", "marrow.v1.SegmentationService", "marrow.v1.MeshStoreService",
        "marrow.v1.SpectrumService", "marrow.v1.CapabilitiesService"}) {
    EXPECT_EQ(Health(channel_, service), "SERVING") << service;
  }
  EXPECT_EQ(Health(channel_, "marrow.v1.NoService"), "error");
}

TEST_F(ServerTest, ReflectionListsTheServicesOfOneServerAlone) {
  Start();
  const auto [status, services] = ListServices(channel_);
  EXPECT_TRUE(status.ok());
  EXPECT_THAT(services, ::testing::HasSubstr("marrow.v1.SegmentationService"));

  EXPECT_THAT(FileOf(channel_, "marrow.v1.SegmentationService"),
              ::testing::HasSubstr("segmentation_service.proto"));
  EXPECT_THAT(FileOf(channel_, "grpc.health.v1.Health"),
              ::testing::HasSubstr("health.proto"));

  options_.reflection = false;
  const auto silent = Server::Start(options_);
  ASSERT_TRUE(silent.ok());
  EXPECT_EQ(ListServices((*silent)->InProcessChannel()).first.error_code(),
            grpc::StatusCode::UNIMPLEMENTED);
}

TEST_F(ServerTest, CapabilitiesGiveLimitsAndDefaults) {
  options_.mesh_limits.max_faces = 123;
  Start();
  grpc::ClientContext context;
  v1::GetCapabilitiesResponse response;
  ASSERT_TRUE(v1::CapabilitiesService::NewStub(channel_)
                  ->GetCapabilities(&context, {}, &response)
                  .ok());
  EXPECT_EQ(response.version(), kVersion);
  EXPECT_EQ(response.mesh_limits().max_faces(), 123u);
  EXPECT_EQ(response.mesh_limits().max_inline_mesh_bytes(), 1u << 20);
  EXPECT_EQ(response.default_options().method(), v1::METHOD_MERGE);
  EXPECT_EQ(response.default_options().kappa(), 1.5);
  EXPECT_EQ(response.automatic_salience(), kAutomaticSalience);
  EXPECT_EQ(response.result_cache_bytes(), options_.result_cache_bytes);
  EXPECT_EQ(response.default_options().eigen_pairs(), 200u);
  EXPECT_THAT(response.methods(),
              ::testing::ElementsAre(v1::METHOD_PAPER, v1::METHOD_MERGE));
  ASSERT_GT(response.parameter_ranges_size(), 0);
  EXPECT_EQ(response.parameter_ranges_size(), 6);
}

TEST_F(ServerTest, NoMoreIsTakenInlineThanAMeshMayHave) {
  options_.mesh_limits.max_bytes = 1000;
  Start();
  grpc::ClientContext context;
  v1::GetCapabilitiesResponse response;
  ASSERT_TRUE(v1::CapabilitiesService::NewStub(channel_)
                  ->GetCapabilities(&context, {}, &response)
                  .ok());
  EXPECT_EQ(response.mesh_limits().max_inline_mesh_bytes(), 1000u);
  const Answer answer = Segment(Request(std::string(1001, 'x')));
  EXPECT_THAT(answer.status.error_message(),
              ::testing::HasSubstr("must be 1 to 1000"));
}

TEST_F(ServerTest, WithoutASocketTheInProcessChannelServes) {
  options_.listen = "";
  auto server = Server::Start(options_, engine_);
  ASSERT_TRUE(server.ok());
  EXPECT_EQ((*server)->port(), 0);
  segmentation_ =
      v1::SegmentationService::NewStub((*server)->InProcessChannel());
  EXPECT_TRUE(Segment(Request(StarPayload(2))).status.ok());
}

TEST_F(ServerTest, ATakenPortIsAnError) {
  Start();
  options_.listen = "127.0.0.1:" + std::to_string(server_->port());
  const auto second = Server::Start(options_, engine_);
  EXPECT_EQ(second.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(second.status().message()),
              ::testing::HasSubstr(options_.listen));
}

TEST_F(ServerTest, ImpossibleOptionsAreErrors) {
  const auto code = [this](const auto& spoil) {
    ServerOptions options = options_;
    spoil(options);
    return Server::Start(options, engine_).status().code();
  };
  constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;
  EXPECT_EQ(code([](auto& o) { o.compute_threads = -1; }), kInvalid);
  EXPECT_EQ(code([](auto& o) { o.max_queued_jobs = -1; }), kInvalid);
  EXPECT_EQ(code([](auto& o) { o.mesh_store_bytes = 1; }), kInvalid);
  EXPECT_EQ(code([](auto& o) { o.mesh_limits.max_faces = 0; }), kInvalid);
  EXPECT_EQ(code([](auto& o) { o.max_inline_mesh_bytes = 2 << 20; }), kInvalid);
}

TEST_F(ServerTest, MessagesAboveTheReceiveLimitAreRefused) {
  Start();
  v1::SegmentRequest request;
  request.mutable_mesh()->set_draco(std::string(5 << 20, 'x'));
  EXPECT_EQ(Segment(request).status.error_code(),
            grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(Segment(Request(StarPayload(1))).status.ok());
}

TEST_F(ServerTest, DrainingFinishesWhatRunsAndRefusesTheRest) {
  Start();
  solver_->hold = true;
  Answer running;
  std::thread client([&] { running = Segment(Request(StarPayload(3))); });
  ASSERT_TRUE(WaitUntil([&] { return solver_->calls == 1; }));
  std::thread drain([&] { server_->Drain(std::chrono::seconds(60)); });
  EXPECT_TRUE(WaitUntil([&] { return Health(channel_, "") == "NOT_SERVING"; }));
  const Answer refused = Segment(Request(StarPayload(2)));
  EXPECT_EQ(refused.status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(ReasonIn(refused.status), "DRAINING");
  solver_->hold = false;
  client.join();
  drain.join();
  EXPECT_TRUE(running.status.ok()) << running.status.error_message();
}

TEST_F(ServerTest, DrainingCancelsWhatOutlastsTheGrace) {
  Start();
  solver_->hold = true;
  Answer running;
  std::thread client([&] { running = Segment(Request(StarPayload(3))); });
  ASSERT_TRUE(WaitUntil([&] { return solver_->calls == 1; }));
  const auto begin = std::chrono::steady_clock::now();
  server_->Drain(milliseconds(200));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  client.join();
  EXPECT_FALSE(running.status.ok());
  EXPECT_TRUE(WaitUntil([&] { return solver_->cancelled == 1; }));
}

TEST_F(ServerTest, ManyClientsThatComeAndGoLeaveNothingBehind) {
  Start();
  std::vector<std::thread> clients;
  for (int i = 0; i < 8; ++i) {
    clients.emplace_back([this, i] {
      for (int k = 0; k < 12; ++k) {
        grpc::ClientContext context;
        context.set_deadline(std::chrono::system_clock::now() +
                             milliseconds(k % 3 == 0 ? 1 + i * k : 60'000));
        v1::SegmentRequest request = Request(StarPayload(1, 1 + (i + k) % 4));
        const Answer answer = Segment(request, context);
        EXPECT_TRUE(answer.status.ok() || k % 3 == 0)
            << answer.status.error_message();
      }
    });
  }
  for (std::thread& client : clients) client.join();
  const auto begin = std::chrono::steady_clock::now();
  server_->Drain(std::chrono::seconds(30));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

}  // namespace
}  // namespace marrow::testing
