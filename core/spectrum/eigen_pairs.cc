#include "core/spectrum/eigen_pairs.h"

#include "core/base/status_macros.h"

namespace marrow {
namespace {

class WholeStream : public EigenPairStream {
 public:
  WholeStream(EigenPairSource& source, const CanonicalMesh& mesh,
              uint32_t count)
      : source_(source), mesh_(mesh), count_(count) {}

  absl::StatusOr<std::shared_ptr<const EigenPairs>> UpTo(
      double, const CancelToken& cancel,
      const ProgressCallback& progress) override {
    if (pairs_ == nullptr) {
      MARROW_ASSIGN_OR_RETURN(pairs_,
                              source_.Get(mesh_, count_, cancel, progress));
    }
    return pairs_;
  }

 private:
  EigenPairSource& source_;
  const CanonicalMesh& mesh_;
  const uint32_t count_;
  std::shared_ptr<const EigenPairs> pairs_;
};

}  // namespace

EigenPairs FirstPairs(const EigenPairs& pairs, uint32_t count) {
  return {.eigenvalues = pairs.eigenvalues.head(count),
          .eigenvectors = pairs.eigenvectors.leftCols(count),
          .area = pairs.area,
          .laplacian = pairs.laplacian,
          .complete = false,
          .for_any_count = pairs.for_any_count};
}

std::unique_ptr<EigenPairStream> EigenPairSource::Open(
    const CanonicalMesh& mesh, uint32_t count) {
  return std::make_unique<WholeStream>(*this, mesh, count);
}

}  // namespace marrow
