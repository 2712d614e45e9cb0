#include "server/mesh_store.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"

namespace marrow {
namespace {

absl::Status Mismatch(const std::string& message) {
  return WithReason(absl::InvalidArgumentError(message), kReasonDigestMismatch);
}

}  // namespace

MeshStore::MeshStore(uint64_t budget_bytes)
    : budget_(budget_bytes), payloads_(budget_bytes) {}

absl::StatusOr<std::shared_ptr<const std::string>> MeshStore::Find(
    const MeshDigest& digest) {
  absl::MutexLock lock(&mu_);
  std::shared_ptr<const std::string> payload = payloads_.Find(digest.sha256);
  if (payload != nullptr && payload->size() != digest.size_bytes) {
    return Mismatch(absl::StrCat("size_bytes is ", digest.size_bytes,
                                 ", but the mesh of this SHA-256 has ",
                                 payload->size(), " bytes"));
  }
  return payload;
}

std::shared_ptr<const std::string> MeshStore::Put(const Digest& sha256,
                                                  std::string payload) {
  absl::MutexLock lock(&mu_);
  if (auto kept = payloads_.Find(sha256)) return kept;
  auto value = std::make_shared<const std::string>(std::move(payload));
  payloads_.Insert(sha256, value, value->size());
  return value;
}

std::unique_ptr<MeshStore::Upload> MeshStore::BeginUpload(
    const MeshDigest& digest) {
  return std::unique_ptr<Upload>(new Upload(this, digest));
}

bool MeshStore::Hold(uint64_t bytes) {
  absl::MutexLock lock(&mu_);
  if (held_by_uploads_ + bytes > budget_) return false;
  held_by_uploads_ += bytes;
  return true;
}

void MeshStore::Release(uint64_t bytes) {
  absl::MutexLock lock(&mu_);
  held_by_uploads_ -= bytes;
}

MeshStore::Upload::Upload(MeshStore* store, const MeshDigest& digest)
    : store_(store), digest_(digest), hash_("") {}

MeshStore::Upload::~Upload() { store_->Release(held_); }

absl::Status MeshStore::Upload::Add(uint64_t offset, const std::string& data) {
  if (offset != received()) {
    return InvalidField(
        "chunk.offset",
        absl::StrCat("is ", offset, ", but ", received(),
                     " bytes have come; send chunks in order, without gaps"));
  }
  if (data.size() > digest_.size_bytes - received()) {
    return InvalidField("chunk.data",
                        absl::StrCat("goes beyond the ", digest_.size_bytes,
                                     " bytes that header.size_bytes declares"));
  }
  if (!store_->Hold(data.size())) {
    return WithReason(
        absl::UnavailableError("too many uploads are under way; try again"),
        kReasonOverloaded);
  }
  held_ += data.size();
  hash_.Add(data.data(), data.size());
  bytes_.append(data);
  return absl::OkStatus();
}

absl::Status MeshStore::Upload::Finish() {
  if (received() != digest_.size_bytes) {
    return Mismatch(absl::StrCat("the upload ended after ", received(), " of ",
                                 digest_.size_bytes, " bytes"));
  }
  const Digest found = hash_.Finish();
  if (found != digest_.sha256) {
    return Mismatch(absl::StrCat("the bytes that came have SHA-256 ",
                                 found.Hex(), ", not ", digest_.sha256.Hex()));
  }
  store_->Put(found, std::move(bytes_));
  return absl::OkStatus();
}

}  // namespace marrow
