#include "server/result_cache.h"

#include <utility>

namespace marrow {

Digest ResultCache::KeyOf(const MeshDigest& mesh,
                          const SegmentationOptions& options) {
  DigestBuilder key("marrow result 1");
  key.AddString(mesh.sha256.Hex());
  key.AddU64(mesh.size_bytes);
  key.AddU64(static_cast<uint64_t>(options.method));
  for (const double value : {options.split.kappa, options.split.delta,
                             options.split.epsilon, options.split.tolerance}) {
    key.Add(&value, sizeof(value));
  }
  key.AddU64(options.eigen_pairs);
  key.AddU64(options.levels);
  return key.Finish();
}

std::shared_ptr<const SegmentedMesh> ResultCache::Find(const Digest& key) {
  absl::MutexLock lock(&mu_);
  return entries_.Find(key);
}

void ResultCache::Insert(const Digest& key,
                         std::shared_ptr<const SegmentedMesh> result) {
  const uint64_t bytes = result->Bytes();
  absl::MutexLock lock(&mu_);
  entries_.Insert(key, std::move(result), bytes);
}

}  // namespace marrow
