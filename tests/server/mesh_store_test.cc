#include "server/mesh_store.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/error_reason.h"

namespace marrow {
namespace {

MeshDigest DigestOf(const std::string& payload) {
  return {Sha256(payload), payload.size()};
}

TEST(MeshStoreTest, FindsWhatWasPut) {
  MeshStore store(100);
  const std::string payload = "payload";
  EXPECT_EQ(*store.Find(DigestOf(payload)), nullptr);
  store.Put(Sha256(payload), payload);
  EXPECT_EQ(**store.Find(DigestOf(payload)), payload);
}

TEST(MeshStoreTest, RefusesAnotherSizeForAKnownDigest) {
  MeshStore store(100);
  store.Put(Sha256("payload"), "payload");
  const auto found = store.Find({Sha256("payload"), 8});
  EXPECT_EQ(ReasonOf(found.status()), kReasonDigestMismatch);
}

TEST(MeshStoreTest, DropsTheOldestButNotFromItsHolders) {
  MeshStore store(10);
  const auto held = store.Put(Sha256("123456"), "123456");
  store.Put(Sha256("abcdef"), "abcdef");
  EXPECT_EQ(*store.Find(DigestOf("123456")), nullptr);
  EXPECT_EQ(*held, "123456");
}

TEST(MeshStoreTest, AnUploadInOrderIsKept) {
  MeshStore store(100);
  auto upload = store.BeginUpload(DigestOf("payload"));
  EXPECT_TRUE(upload->Add(0, "pay").ok());
  EXPECT_TRUE(upload->Add(3, "load").ok());
  EXPECT_TRUE(upload->Finish().ok());
  EXPECT_EQ(**store.Find(DigestOf("payload")), "payload");
}

TEST(MeshStoreTest, AnUploadRefusesGapsOverlapsAndExcess) {
  MeshStore store(100);
  auto upload = store.BeginUpload(DigestOf("payload"));
  EXPECT_EQ(FieldOf(upload->Add(1, "a")), "chunk.offset");
  EXPECT_TRUE(upload->Add(0, "pay").ok());
  EXPECT_EQ(FieldOf(upload->Add(2, "y")), "chunk.offset");
  EXPECT_EQ(FieldOf(upload->Add(3, "loads")), "chunk.data");
  EXPECT_EQ(FieldOf(upload->Add(~0ull, "x")), "chunk.offset");
}

TEST(MeshStoreTest, AnUploadThatIsShortOrFalseIsNotKept) {
  MeshStore store(100);
  auto upload = store.BeginUpload(DigestOf("payload"));
  EXPECT_TRUE(upload->Add(0, "pay").ok());
  EXPECT_EQ(ReasonOf(upload->Finish()), kReasonDigestMismatch);
  upload = store.BeginUpload(DigestOf("payload"));
  EXPECT_TRUE(upload->Add(0, "PAYLOAD").ok());
  EXPECT_EQ(ReasonOf(upload->Finish()), kReasonDigestMismatch);
  EXPECT_EQ(*store.Find(DigestOf("payload")), nullptr);
}

TEST(MeshStoreTest, UploadsTogetherHoldNoMoreThanTheBudget) {
  MeshStore store(10);
  auto first = store.BeginUpload(DigestOf("12345678"));
  EXPECT_TRUE(first->Add(0, "12345678").ok());
  auto second = store.BeginUpload(DigestOf("abcdef"));
  EXPECT_EQ(ReasonOf(second->Add(0, "abcdef")), kReasonOverloaded);
  first.reset();
  EXPECT_TRUE(second->Add(0, "abcdef").ok());
}

}  // namespace
}  // namespace marrow
