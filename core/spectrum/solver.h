// The eigensolver: spectrum slicing (slicing.h), a dense solver for tiny
// meshes.
#ifndef MARROW_CORE_SPECTRUM_SOLVER_H_
#define MARROW_CORE_SPECTRUM_SOLVER_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "core/spectrum/eigen_pairs.h"
#include "core/spectrum/slicing.h"

namespace marrow {

// Changes whenever the same mesh may give other bytes.
inline constexpr char kSolverRevision[] = "slicing/8";

// What the residual ||L phi - lambda M phi|| of a pair, in the M^-1 norm, may
// be in units of max(lambda, lambda_1). Segmentations are the same at the first
// as at any smaller one.
inline constexpr double kSolverTolerance = 1e-4;
// Of pairs that are to be made strict by refinement.
inline constexpr double kStrictSolverTolerance = 1e-7;

// Solves anew at every call; keeps nothing.
class SolverEigenPairSource : public EigenPairSource {
 public:
  explicit SolverEigenPairSource(double tolerance = kSolverTolerance)
      : tolerance_(tolerance) {}

  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) override;
  // Solves a band at a time.
  std::unique_ptr<EigenPairStream> Open(const CanonicalMesh& mesh,
                                        uint32_t count) override;
  bool GivesSharedPairs(const CanonicalMesh& mesh,
                        uint32_t count) const override;

 private:
  const double tolerance_;
};

// Predicted cost of Get() on a machine of today; linear models fitted to
// measurements, good to a factor of two.
double PredictSolverSeconds(uint64_t vertices, uint32_t count);
uint64_t PredictSolverBytes(uint64_t vertices, uint32_t count);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SOLVER_H_
