// What a stranger may send: bad fields, unknown digests, hostile bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "server/segmentation_service.h"
#include "tests/server/service_fixture.h"
#include "tests/testing/draco_encode.h"
#include "tests/testing/shapes.h"

namespace marrow::testing {
namespace {

class RefusalTest : public ServiceTest {};

TEST_F(RefusalTest, BadFieldsAreNamed) {
  Start();
  const std::string payload = StarPayload(1);
  const auto expect = [&](const std::string& field, const auto& spoil) {
    v1::SegmentRequest request = Request(payload);
    spoil(request);
    const Answer answer = Segment(request);
    EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT)
        << field;
    EXPECT_EQ(ReasonIn(answer.status), "INVALID_PARAMETER " + field);
    EXPECT_TRUE(answer.events.empty());
  };
  using R = v1::SegmentRequest;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect("mesh", [](R& r) { r.clear_mesh(); });
  expect("mesh.source", [](R& r) { r.mutable_mesh()->clear_source(); });
  expect("mesh.draco", [](R& r) { r.mutable_mesh()->set_draco(""); });
  expect("mesh.draco", [](R& r) {
    r.mutable_mesh()->set_draco(std::string((1 << 20) + 1, 'x'));
  });
  expect("mesh.digest.sha256",
         [](R& r) { r.mutable_mesh()->mutable_digest()->set_sha256("short"); });
  expect("mesh.digest.size_bytes", [](R& r) {
    r.mutable_mesh()->mutable_digest()->set_sha256(std::string(32, 'x'));
  });
  expect("mesh.digest.size_bytes", [](R& r) {
    r.mutable_mesh()->mutable_digest()->set_sha256(std::string(32, 'x'));
    r.mutable_mesh()->mutable_digest()->set_size_bytes(~0ull);
  });
  expect("options.method",
         [](R& r) { r.mutable_options()->set_method(v1::Method(77)); });
  expect("options.kappa", [](R& r) { r.mutable_options()->set_kappa(-1); });
  expect("options.kappa", [&](R& r) { r.mutable_options()->set_kappa(nan); });
  expect("options.delta", [](R& r) { r.mutable_options()->set_delta(0); });
  expect("options.epsilon", [](R& r) { r.mutable_options()->set_epsilon(2); });
  expect("options.tolerance",
         [](R& r) { r.mutable_options()->set_tolerance(-0.1); });
  expect("options.eigen_pairs",
         [](R& r) { r.mutable_options()->set_eigen_pairs(0); });
  expect("options.eigen_pairs",
         [](R& r) { r.mutable_options()->set_eigen_pairs(1u << 31); });
  expect("options.levels", [](R& r) { r.mutable_options()->set_levels(0); });
  expect("outputs.levels[1]", [](R& r) {
    r.mutable_outputs()->add_levels(1);
    r.mutable_outputs()->add_levels(3);
  });
  expect("outputs.label_domains[0]", [](R& r) {
    r.mutable_outputs()->add_label_domains(v1::LABEL_DOMAIN_UNSPECIFIED);
  });
  expect("outputs.label_domains[0]", [](R& r) {
    r.mutable_outputs()->add_label_domains(v1::LabelDomain(9));
  });
  EXPECT_EQ(runs_, 0);
}

TEST_F(RefusalTest, AnUnknownDigestIsMissing) {
  Start();
  v1::SegmentRequest request;
  request.mutable_mesh()->mutable_digest()->set_sha256(std::string(32, 'x'));
  request.mutable_mesh()->mutable_digest()->set_size_bytes(5);
  const Answer answer = Segment(request);
  EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(ReasonIn(answer.status), "MESH_MISSING");
  EXPECT_EQ(DetailsOf(answer.status).details(1).type_url(),
            "type.googleapis.com/google.rpc.PreconditionFailure");
}

TEST_F(RefusalTest, AnInlineMeshCanBeNamedByItsDigestLater) {
  Start();
  v1::SegmentRequest request = Request(StarPayload(3));
  const Answer first = Segment(request);
  *request.mutable_mesh()->mutable_digest() =
      first.events[0].accepted().mesh_digest();
  EXPECT_EQ(Segment(request).Essence(), first.Essence());
}

TEST_F(RefusalTest, HostileBytesAreRefusedAndTheServerLives) {
  Start();
  const std::string good = StarPayload(2);
  std::vector<std::string> hostile = {"x", "DRACO", std::string(1000, '\0'),
                                      "solid cube\nfacet normal 0 0 1\n"};
  for (size_t size = 1; size < good.size(); size += good.size() / 20) {
    hostile.push_back(good.substr(0, size));
  }
  for (const std::string& bytes : hostile) {
    const Answer answer = Segment(Request(bytes));
    EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_THAT(ReasonIn(answer.status),
                ::testing::AnyOf("DRACO_DECODE_FAILED", "MESH_REJECTED"));
  }
  EXPECT_TRUE(Segment(Request(good)).status.ok());
}

// A flipped bit may still give a mesh: then it is answered.
TEST_F(RefusalTest, FlippedBitsAreAnsweredOrRefused) {
  Start();
  const std::string good = StarPayload(1);
  for (size_t bit = 3; bit < good.size() * 8; bit += good.size() * 8 / 60) {
    std::string flipped = good;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    const Answer answer = Segment(Request(flipped));
    EXPECT_THAT(answer.status.error_code(),
                ::testing::AnyOf(grpc::StatusCode::OK,
                                 grpc::StatusCode::INVALID_ARGUMENT))
        << "bit " << bit << ": " << answer.status.error_message();
  }
  EXPECT_TRUE(Segment(Request(good)).status.ok());
}

// The hostile files of the development data, where they are.
TEST_F(RefusalTest, HostileFilesAreAnsweredOrRefused) {
  const char* data = std::getenv("MARROW_DATA");
  const auto folder =
      std::filesystem::path(data == nullptr ? "" : data) / "draco" / "hostile";
  if (!std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "MARROW_DATA has no draco/hostile";
  }
  Start();
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    // Large valid meshes are another test's.
    if (entry.path().filename().string().starts_with("legit")) continue;
    const Answer answer = Segment(Request(bytes));
    EXPECT_THAT(answer.status.error_code(),
                ::testing::AnyOf(grpc::StatusCode::OK,
                                 grpc::StatusCode::INVALID_ARGUMENT))
        << entry.path() << ": " << answer.status.error_message();
  }
  EXPECT_TRUE(Segment(Request(StarPayload(1))).status.ok());
}

}  // namespace
}  // namespace marrow::testing
