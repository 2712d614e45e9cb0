#include "server/mesh_store_service.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/crc32c.h"
#include "core/base/digest.h"
#include "tests/server/service_fixture.h"

namespace marrow::testing {
namespace {

v1::MeshDigest DigestOf(const std::string& payload) {
  const Digest sha256 = Sha256(payload);
  v1::MeshDigest digest;
  digest.set_sha256(std::string(sha256.bytes.begin(), sha256.bytes.end()));
  digest.set_size_bytes(payload.size());
  return digest;
}

v1::UploadMeshRequest Header(const v1::MeshDigest& digest) {
  v1::UploadMeshRequest message;
  *message.mutable_header() = digest;
  return message;
}

v1::UploadMeshRequest Chunk(uint64_t offset, const std::string& data) {
  v1::UploadMeshRequest message;
  message.mutable_chunk()->set_offset(offset);
  message.mutable_chunk()->set_data(data);
  message.mutable_chunk()->set_data_crc32c(Crc32c(data));
  return message;
}

class MeshStoreServiceTest : public ServiceTest {
 protected:
  grpc::Status Upload(const std::vector<v1::UploadMeshRequest>& messages) {
    grpc::ClientContext context;
    auto writer = store_->UploadMesh(&context, &response_);
    for (const auto& message : messages) {
      if (!writer->Write(message)) break;
    }
    writer->WritesDone();
    return writer->Finish();
  }

  bool IsMissing(const v1::MeshDigest& digest) {
    v1::FindMissingMeshesRequest request;
    *request.add_digests() = digest;
    v1::FindMissingMeshesResponse response;
    grpc::ClientContext context;
    EXPECT_TRUE(store_->FindMissingMeshes(&context, request, &response).ok());
    return response.missing_size() == 1;
  }

  grpc::Status Inspect(const v1::InspectMeshRequest& request,
                       v1::InspectMeshResponse& response) {
    grpc::ClientContext context;
    return store_->InspectMesh(&context, request, &response);
  }

  v1::UploadMeshResponse response_;
};

TEST_F(MeshStoreServiceTest, AnUploadedMeshCanBeSegmented) {
  Start();
  const std::string payload = StarPayload(3);
  const v1::MeshDigest digest = DigestOf(payload);
  EXPECT_TRUE(IsMissing(digest));
  std::vector<v1::UploadMeshRequest> messages = {Header(digest)};
  for (size_t at = 0; at < payload.size(); at += 1000) {
    messages.push_back(Chunk(at, payload.substr(at, 1000)));
  }
  const grpc::Status status = Upload(messages);
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_FALSE(response_.already_present());
  EXPECT_EQ(response_.digest().sha256(), digest.sha256());
  EXPECT_FALSE(IsMissing(digest));

  v1::SegmentRequest request = Request(payload);
  const Answer inlined = Segment(request);
  *request.mutable_mesh()->mutable_digest() = digest;
  EXPECT_EQ(Segment(request).Essence(), inlined.Essence());
}

TEST_F(MeshStoreServiceTest, ASecondUploadEndsEarly) {
  Start();
  const v1::MeshDigest digest = DigestOf("payload");
  EXPECT_TRUE(Upload({Header(digest), Chunk(0, "payload")}).ok());
  EXPECT_TRUE(Upload({Header(digest)}).ok());
  EXPECT_TRUE(response_.already_present());
}

TEST_F(MeshStoreServiceTest, FalseUploadsAreRefused) {
  options_.mesh_limits.max_bytes = 2 << 20;
  Start();
  const v1::MeshDigest digest = DigestOf("payload");
  const auto expect = [&](const std::string& reason,
                          const std::vector<v1::UploadMeshRequest>& messages) {
    const grpc::Status status = Upload(messages);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT)
        << reason;
    EXPECT_EQ(ReasonIn(status), reason);
  };
  v1::MeshDigest large = digest;
  large.set_size_bytes((2 << 20) + 1);
  v1::MeshDigest longer = digest;
  longer.set_size_bytes(9);
  v1::UploadMeshRequest damaged = Chunk(0, "payload");
  damaged.mutable_chunk()->set_data_crc32c(1);
  expect("INVALID_PARAMETER header", {});
  expect("INVALID_PARAMETER header", {Chunk(0, "payload")});
  expect("INVALID_PARAMETER header.sha256", {Header({})});
  expect("INVALID_PARAMETER header.size_bytes", {Header(large)});
  expect("INVALID_PARAMETER chunk", {Header(digest), Header(digest)});
  expect("INVALID_PARAMETER chunk", {Header(digest), {}});
  expect("INVALID_PARAMETER chunk.data", {Header(digest), Chunk(0, "")});
  expect("INVALID_PARAMETER chunk.data",
         {Header(longer), Chunk(0, std::string((1 << 20) + 1, 'x'))});
  expect("INVALID_PARAMETER chunk.data",
         {Header(digest), Chunk(0, "payload and more")});
  expect("INVALID_PARAMETER chunk.data_crc32c", {Header(digest), damaged});
  expect("INVALID_PARAMETER chunk.offset",
         {Header(digest), Chunk(0, "pay"), Chunk(4, "oad")});
  expect("INVALID_PARAMETER chunk.offset",
         {Header(digest), Chunk(0, "pay"), Chunk(0, "pay")});
  expect("DIGEST_MISMATCH", {Header(digest), Chunk(0, "pay")});
  expect("DIGEST_MISMATCH", {Header(digest), Chunk(0, "PAYLOAD")});
  EXPECT_TRUE(IsMissing(digest));
}

TEST_F(MeshStoreServiceTest, AKnownDigestOfAnotherSizeIsAMismatch) {
  Start();
  v1::MeshDigest digest = DigestOf("payload");
  EXPECT_TRUE(Upload({Header(digest), Chunk(0, "payload")}).ok());
  digest.set_size_bytes(8);
  v1::SegmentRequest request;
  *request.mutable_mesh()->mutable_digest() = digest;
  EXPECT_EQ(ReasonIn(Segment(request).status), "DIGEST_MISMATCH");
}

TEST_F(MeshStoreServiceTest, AnUploadThatStandsStillIsEnded) {
  options_.upload_stall_limit = milliseconds(200);
  Start();
  grpc::ClientContext context;
  auto writer = store_->UploadMesh(&context, &response_);
  EXPECT_TRUE(writer->Write(Header(DigestOf("payload"))));
  const grpc::Status status = writer->Finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
}

TEST_F(MeshStoreServiceTest, TooManyDigestsAreRefused) {
  Start();
  v1::FindMissingMeshesRequest request;
  for (int i = 0; i < 1001; ++i) *request.add_digests() = DigestOf("x");
  v1::FindMissingMeshesResponse response;
  grpc::ClientContext context;
  EXPECT_EQ(ReasonIn(store_->FindMissingMeshes(&context, request, &response)),
            "INVALID_PARAMETER digests");
  grpc::ClientContext other;
  request.Clear();
  *request.add_digests() = DigestOf("x");
  request.add_digests();
  EXPECT_EQ(ReasonIn(store_->FindMissingMeshes(&other, request, &response)),
            "INVALID_PARAMETER digests[1].sha256");
}

TEST_F(MeshStoreServiceTest, InspectReportsTheMeshAndTheCache) {
  Start();
  v1::InspectMeshRequest request;
  request.mutable_mesh()->set_draco(StarPayload(3));
  request.set_eigen_pairs(20);
  v1::InspectMeshResponse response;
  ASSERT_TRUE(Inspect(request, response).ok());
  EXPECT_EQ(response.report().vertices(), 642u);
  EXPECT_EQ(response.report().faces(), 1280u);
  EXPECT_EQ(response.report().components(), 1u);
  EXPECT_EQ(response.report().euler_characteristic(), 2);
  EXPECT_FALSE(response.spectrum_cached());
  EXPECT_GT(response.predicted_seconds(), 0);
  EXPECT_GT(response.predicted_bytes(), 642u * 20 * 8);
  EXPECT_EQ(response.geometry_digest().sha256().size(), 32u);

  const Answer answer = Segment(Request(StarPayload(3)));
  EXPECT_EQ(answer.completed().geometry_digest().sha256(),
            response.geometry_digest().sha256());
  ASSERT_TRUE(Inspect(request, response).ok());
  EXPECT_TRUE(response.spectrum_cached());
  request.set_eigen_pairs(10);
  ASSERT_TRUE(Inspect(request, response).ok());
  EXPECT_TRUE(response.spectrum_cached());
  request.set_eigen_pairs(300);
  ASSERT_TRUE(Inspect(request, response).ok());
  EXPECT_FALSE(response.spectrum_cached());
}

// Merging takes the pairs that its pieces need, and not all must be there.
TEST_F(MeshStoreServiceTest, InspectKnowsWhatSegmentKept) {
  options_.cache_bytes = 0;
  Start();
  v1::SegmentRequest segment;
  segment.mutable_mesh()->set_draco(StarPayload(3));
  v1::InspectMeshRequest request;
  *request.mutable_mesh() = segment.mesh();
  v1::InspectMeshResponse response;
  ASSERT_TRUE(Inspect(request, response).ok());
  EXPECT_FALSE(response.spectrum_cached());
  const Answer answer = Segment(segment);
  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  ASSERT_TRUE(Inspect(request, response).ok());
  EXPECT_TRUE(response.spectrum_cached());
}

TEST_F(MeshStoreServiceTest, InspectRefusesWhatSegmentRefuses) {
  Start();
  v1::InspectMeshRequest request;
  v1::InspectMeshResponse response;
  EXPECT_EQ(ReasonIn(Inspect(request, response)), "INVALID_PARAMETER mesh");
  request.mutable_mesh()->set_draco("DRACO");
  EXPECT_EQ(ReasonIn(Inspect(request, response)), "DRACO_DECODE_FAILED");
  request.set_eigen_pairs(1);
  EXPECT_EQ(ReasonIn(Inspect(request, response)),
            "INVALID_PARAMETER eigen_pairs");
}

}  // namespace
}  // namespace marrow::testing
