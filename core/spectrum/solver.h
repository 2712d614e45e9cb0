// The eigensolver: spectrum slicing (slicing.h), a dense solver for tiny meshes.
#ifndef MARROW_CORE_SPECTRUM_SOLVER_H_
#define MARROW_CORE_SPECTRUM_SOLVER_H_

#include <cstdint>
#include <memory>

#include "absl/status/statusor.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// Changes whenever the same mesh may give other bytes.
inline constexpr char kSolverRevision[] = "slicing/1";

// Solves anew at every call; keeps nothing.
class SolverEigenPairSource : public EigenPairSource {
 public:
  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) override;
};

// Predicted cost of Get() on a machine of today; linear models fitted to
// measurements, good to a factor of two.
double PredictSolverSeconds(uint64_t vertices, uint32_t count);
uint64_t PredictSolverBytes(uint64_t vertices, uint32_t count);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SOLVER_H_
