// A server on a real port of 127.0.0.1, whose engine the test holds in hand.
#ifndef MARROW_TESTS_SERVER_SERVICE_FIXTURE_H_
#define MARROW_TESTS_SERVER_SERVICE_FIXTURE_H_

#include <google/protobuf/any.pb.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "marrow/v1/error_details.pb.h"
#include "marrow/v1/mesh_store_service.grpc.pb.h"
#include "marrow/v1/segmentation_service.grpc.pb.h"
#include "marrow/v1/spectrum_service.grpc.pb.h"
#include "server/engine.h"
#include "server/server.h"
#include "tests/server/test_mesh.h"

namespace marrow::testing {

using std::chrono::milliseconds;

inline bool WaitUntil(const std::function<bool()>& done) {
  for (int i = 0; i < 20'000 && !done(); ++i) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  return done();
}

// The real solver, counted, and held up while `hold` is set.
class CountingSolver : public EigenPairSource {
 public:
  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) override {
    ++calls;
    while (hold && !cancel.IsCancelled()) {
      std::this_thread::sleep_for(milliseconds(1));
    }
    if (cancel.IsCancelled()) ++cancelled;
    return solver_.Get(mesh, count, cancel, progress);
  }

  std::atomic<int> calls{0};
  std::atomic<int> cancelled{0};
  std::atomic<bool> hold{false};

 private:
  SolverEigenPairSource solver_;
};

struct Answer {
  grpc::Status status;
  std::vector<v1::SegmentEvent> events;

  const v1::Accepted& accepted() const { return events.front().accepted(); }
  const v1::Completed& completed() const { return events.back().completed(); }
  // Without what may differ between equal requests.
  std::vector<std::string> Essence() const {
    std::vector<std::string> essence;
    for (v1::SegmentEvent event : events) {
      if (event.has_progress()) continue;
      event.clear_sequence();
      if (event.has_accepted()) {
        event.mutable_accepted()->clear_job_id();
        event.mutable_accepted()->clear_result();
      }
      if (event.has_completed()) {
        event.mutable_completed()->clear_timings();
        event.mutable_completed()->clear_result();
        event.mutable_completed()->mutable_spectrum()->clear_outcome();
        event.mutable_completed()->mutable_spectrum()->clear_solver_runs();
      }
      essence.push_back(event.SerializeAsString());
    }
    return essence;
  }
};

class ServiceTest : public ::testing::Test {
 protected:
  ServiceTest() {
    options_.listen = "127.0.0.1:0";
    options_.compute_threads = 4;
    engine_.solver = solver_;
    // Run() is wrapped, so that its calls are counted.
    engine_.run = [this](auto&&... args) {
      ++runs_;
      return run_(std::forward<decltype(args)>(args)...);
    };
  }

  void Start() {
    auto server = Server::Start(options_, engine_);
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    channel_ =
        grpc::CreateChannel("127.0.0.1:" + std::to_string(server_->port()),
                            grpc::InsecureChannelCredentials());
    segmentation_ = v1::SegmentationService::NewStub(channel_);
    store_ = v1::MeshStoreService::NewStub(channel_);
    spectrum_ = v1::SpectrumService::NewStub(channel_);
  }

  // Few pairs, so that a call takes some milliseconds.
  static v1::SegmentRequest Request(const std::string& payload) {
    v1::SegmentRequest request;
    request.mutable_mesh()->set_draco(payload);
    request.mutable_options()->set_eigen_pairs(20);
    request.mutable_options()->set_levels(2);
    return request;
  }

  Answer Segment(const v1::SegmentRequest& request) {
    grpc::ClientContext context;
    return Segment(request, context);
  }

  Answer Segment(const v1::SegmentRequest& request,
                 grpc::ClientContext& context) {
    Answer answer;
    auto reader = segmentation_->Segment(&context, request);
    v1::SegmentEvent event;
    while (reader->Read(&event)) answer.events.push_back(event);
    answer.status = reader->Finish();
    return answer;
  }

  static v1::RpcStatus DetailsOf(const grpc::Status& status) {
    v1::RpcStatus rpc;
    EXPECT_TRUE(rpc.ParseFromString(status.error_details()));
    return rpc;
  }

  // The reason in a failed call's ErrorInfo, with its field where it has one:
  // "INVALID_PARAMETER options.kappa".
  static std::string ReasonIn(const grpc::Status& status) {
    const v1::RpcStatus details = DetailsOf(status);
    for (const auto& any : details.details()) {
      if (any.type_url() != "type.googleapis.com/google.rpc.ErrorInfo") {
        continue;
      }
      v1::ErrorInfo info;
      EXPECT_TRUE(info.ParseFromString(any.value()));
      const auto field = info.metadata().find("field");
      return field == info.metadata().end()
                 ? info.reason()
                 : info.reason() + " " + field->second;
    }
    return "";
  }

  std::shared_ptr<CountingSolver> solver_ = std::make_shared<CountingSolver>();
  std::atomic<int> runs_{0};
  decltype(Engine::run) run_ = marrow::Run;
  Engine engine_;
  ServerOptions options_;
  std::unique_ptr<Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::SegmentationService::Stub> segmentation_;
  std::unique_ptr<v1::MeshStoreService::Stub> store_;
  std::unique_ptr<v1::SpectrumService::Stub> spectrum_;
};

}  // namespace marrow::testing

#endif  // MARROW_TESTS_SERVER_SERVICE_FIXTURE_H_
