// Keeps eigen-pairs in memory, and computes what it lacks once, however many
// ask for it at the same time.
#ifndef MARROW_SERVER_SPECTRUM_CACHE_H_
#define MARROW_SERVER_SPECTRUM_CACHE_H_

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "core/base/digest.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/eigen_pairs.h"
#include "server/lru_cache.h"

namespace marrow {

enum class CacheOutcome { kHit, kMiss, kJoined };

// How one caller came by its eigen-pairs.
struct SpectrumUse {
  CacheOutcome outcome = CacheOutcome::kHit;
  uint32_t solver_runs = 0;  // by this caller
  uint32_t eigen_pairs = 0;  // without the constant one
  LaplacianReport laplacian;

  // That of several spectra: a miss where one is, else joined where one is.
  void Add(const SpectrumUse& other);
};

// An entry holds the first pairs of a geometry, as many as anyone needed so
// far, whatever the number that they may want in all; it grows. Whoever may
// want fewer is given no more than those, so that no answer depends on what
// others asked for. Pairs that are others for another number
// (EigenPairs::for_any_count) have an entry of their own.
//
// Thread safe.
class SpectrumCache : public EigenPairSource {
 public:
  // An entry above `budget_bytes` is given to those who wait for it but not
  // kept.
  SpectrumCache(std::shared_ptr<EigenPairSource> solver, uint64_t budget_bytes);

  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) override;

  // Get() that also tells in `use` how the pairs were had.
  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress, SpectrumUse& use);

  // Callers for as many pairs of one geometry wait while one of them computes,
  // and then take what it found or go on. They do not wait for callers for
  // another number: who wants few would wait for many. Where that one is
  // cancelled, another takes over; where it fails, those who waited get its
  // error, and whoever asks later tries anew. A caller that is cancelled stops
  // waiting within kPollInterval. Nobody waits for a stream that is not
  // computing.
  std::unique_ptr<EigenPairStream> Open(const CanonicalMesh& mesh,
                                        uint32_t count) override;

  // Open() that also tells in `use`, after every call of the stream, how the
  // pairs were had so far; it must outlive the stream.
  std::unique_ptr<EigenPairStream> Open(const CanonicalMesh& mesh,
                                        uint32_t count, SpectrumUse& use);

  // Whether Get() would be a hit now.
  bool Contains(const CanonicalMesh& mesh, uint32_t count);

  uint64_t bytes();

 private:
  struct Key {
    Digest geometry;
    uint32_t count;  // 0 where it may be any
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  struct Flight;
  class Stream;
  using Result = absl::StatusOr<std::shared_ptr<const EigenPairs>>;

  static Key KeyOf(const CanonicalMesh& mesh, uint32_t count);
  // The key of an entry that has all pairs up to `bound` and one beyond, or
  // key.count of them. Those for any count will do if `shared`.
  std::optional<Key> HolderFor(const Key& key, bool shared, double bound)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_);
  // Ends a flight, which all who wait for it see.
  void Land(const Key& key, Flight& flight, Result result);

  const std::shared_ptr<EigenPairSource> solver_;
  absl::Mutex mu_;
  LruCache<Key, EigenPairs> entries_ ABSL_GUARDED_BY(mu_);
  std::map<Key, std::shared_ptr<Flight>> flights_ ABSL_GUARDED_BY(mu_);
};

}  // namespace marrow

#endif  // MARROW_SERVER_SPECTRUM_CACHE_H_
