// Eigen-pairs in double, to a small residual.
#ifndef MARROW_CORE_SPECTRUM_STRICT_SOLVER_H_
#define MARROW_CORE_SPECTRUM_STRICT_SOLVER_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/canonical_mesh.h"
#include "core/spectrum/certified_spectrum.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// The lowest `count` pairs besides the constant one, or all, orthonormal to
// rounding, each with a residual of at most kStrictResidual where rounding lets
// it be; the residuals tell. Solves anew at every call. Deterministic. Thread
// safe. Errors: CANCELLED; RESOURCE_EXHAUSTED; INTERNAL with reason
// SOLVER_NOT_CONVERGED.
absl::StatusOr<CertifiedSpectrum> SolveStrictly(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_STRICT_SOLVER_H_
