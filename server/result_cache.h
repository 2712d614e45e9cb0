// Keeps segmented meshes in memory, so that their trees can be cut again.
#ifndef MARROW_SERVER_RESULT_CACHE_H_
#define MARROW_SERVER_RESULT_CACHE_H_

#include <cstdint>
#include <memory>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "core/base/digest.h"
#include "core/pipeline/options.h"
#include "core/pipeline/segmented_mesh.h"
#include "server/lru_cache.h"
#include "server/mesh_store.h"

namespace marrow {

// Results are those of a payload, since labels are in its order, and of all
// parameters. What was used longest ago goes first. Thread safe.
class ResultCache {
 public:
  // A result above `budget_bytes` is not kept.
  explicit ResultCache(uint64_t budget_bytes) : entries_(budget_bytes) {}

  static Digest KeyOf(const MeshDigest& mesh,
                      const SegmentationOptions& options);

  // Null where there is none.
  std::shared_ptr<const SegmentedMesh> Find(const Digest& key);
  void Insert(const Digest& key, std::shared_ptr<const SegmentedMesh> result);

 private:
  absl::Mutex mu_;
  LruCache<Digest, SegmentedMesh> entries_ ABSL_GUARDED_BY(mu_);
};

}  // namespace marrow

#endif  // MARROW_SERVER_RESULT_CACHE_H_
