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
inline constexpr char kSolverRevision[] = "slicing/2";

// What the residual ||L phi - lambda M phi|| of a pair, in the M^-1 norm, may
// be in units of max(lambda, lambda_1). Segmentations are the same at the first
// as at any smaller one.
inline constexpr double kSolverTolerance = 1e-4;
// Of pairs in double, and of those that certified_spectrum.h is to make strict.
inline constexpr double kStrictTolerance = 1e-8;
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

 private:
  const double tolerance_;
};

// As EigenPairs, in double and with the evidence.
struct CertifiedPairs {
  Eigen::VectorXd eigenvalues;
  // n x pairs, M-orthonormal to 1e-10.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      eigenvectors;
  // Of each pair, as above; that of the constant one is 0.
  Eigen::VectorXd residuals;
  // Ascending: so many eigenvalues are below each shift, by inertia. The last
  // shift is at or beyond the last pair. Empty where a dense solver found all.
  std::vector<InertiaCount> counts;
  double area = 0;
};

// min(count + 1, mesh.vertices) pairs with residuals up to `tolerance`, which
// is kStrictTolerance or the like. Errors: as EigenPairSource::Get().
absl::StatusOr<CertifiedPairs> SolveCertified(const CanonicalMesh& mesh,
                                              uint32_t count, double tolerance,
                                              const CancelToken& cancel,
                                              const ProgressCallback& progress);

// Predicted cost of Get() on a machine of today; linear models fitted to
// measurements, good to a factor of two.
double PredictSolverSeconds(uint64_t vertices, uint32_t count);
uint64_t PredictSolverBytes(uint64_t vertices, uint32_t count);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SOLVER_H_
