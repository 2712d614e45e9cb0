// The eigensolver: spectrum slicing (slicing.h), a dense solver for tiny
// meshes.
#ifndef MARROW_CORE_SPECTRUM_SOLVER_H_
#define MARROW_CORE_SPECTRUM_SOLVER_H_

#include <cstdint>
#include <memory>

#include "absl/status/statusor.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// Changes whenever the same mesh may give other bytes.
inline constexpr char kSolverRevision[] = "slicing/1";

// Of pairs for segmentation, and of those that are to be strict
// (certified_spectrum.h).
inline constexpr double kSolverTolerance = 1e-6;
inline constexpr double kStrictSolverTolerance = 1e-9;

// Solves anew at every call; keeps nothing.
class SolverEigenPairSource : public EigenPairSource {
 public:
  // `tolerance`: what the residual of a pair may be before it is rounded, in
  // units of max(lambda, lambda_1).
  explicit SolverEigenPairSource(double tolerance = kSolverTolerance)
      : tolerance_(tolerance) {}

  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) override;

 private:
  const double tolerance_;
};

// Predicted cost of Get() on a machine of today; linear models fitted to
// measurements, good to a factor of two.
double PredictSolverSeconds(uint64_t vertices, uint32_t count);
uint64_t PredictSolverBytes(uint64_t vertices, uint32_t count);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SOLVER_H_
