// Keeps uploaded payloads in memory under their SHA-256.
#ifndef MARROW_SERVER_MESH_STORE_H_
#define MARROW_SERVER_MESH_STORE_H_

#include <cstdint>
#include <memory>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "core/base/digest.h"
#include "server/lru_cache.h"

namespace marrow {

// The name of a payload: its bytes as sent.
struct MeshDigest {
  Digest sha256;
  uint64_t size_bytes = 0;
};

// Thread safe. A payload that is dropped lives on with the jobs that hold it.
class MeshStore {
 public:
  // Uploads under way hold at most `budget_bytes` together, besides the
  // `budget_bytes` of what is kept.
  explicit MeshStore(uint64_t budget_bytes);

  // Null where it is not there. INVALID_ARGUMENT with reason DIGEST_MISMATCH
  // where the payload of that SHA-256 has another size.
  absl::StatusOr<std::shared_ptr<const std::string>> Find(
      const MeshDigest& digest);

  // REQUIRES: `sha256` is the payload's. Returns what is kept.
  std::shared_ptr<const std::string> Put(const Digest& sha256,
                                         std::string payload);

  // A payload that arrives in pieces. Not thread safe by itself; the store
  // must outlive it.
  class Upload {
   public:
    ~Upload();
    Upload(const Upload&) = delete;
    Upload& operator=(const Upload&) = delete;

    // Errors: INVALID_ARGUMENT with a field where `offset` is not received()
    // or the declared size is exceeded; UNAVAILABLE with reason OVERLOADED
    // where too many bytes of uploads are held.
    absl::Status Add(uint64_t offset, const std::string& data);

    // Checks size and SHA-256 and keeps the payload. INVALID_ARGUMENT with
    // reason DIGEST_MISMATCH. At most once.
    absl::Status Finish();

    uint64_t received() const { return bytes_.size(); }

   private:
    friend class MeshStore;
    Upload(MeshStore* store, const MeshDigest& digest);

    MeshStore* const store_;
    const MeshDigest digest_;
    DigestBuilder hash_;
    std::string bytes_;
    uint64_t held_ = 0;
  };

  // REQUIRES: the declared size is within the limits.
  std::unique_ptr<Upload> BeginUpload(const MeshDigest& digest);

 private:
  bool Hold(uint64_t bytes);
  void Release(uint64_t bytes);

  const uint64_t budget_;
  absl::Mutex mu_;
  LruCache<Digest, std::string> payloads_ ABSL_GUARDED_BY(mu_);
  uint64_t held_by_uploads_ ABSL_GUARDED_BY(mu_) = 0;
};

}  // namespace marrow

#endif  // MARROW_SERVER_MESH_STORE_H_
