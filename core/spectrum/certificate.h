// What makes a CertifiedSpectrum certain: residuals, and a count.
#ifndef MARROW_CORE_SPECTRUM_CERTIFICATE_H_
#define MARROW_CORE_SPECTRUM_CERTIFICATE_H_

#include <Eigen/Core>
#include <cstddef>
#include <functional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/certified_spectrum.h"
#include "core/spectrum/slicing.h"

namespace marrow {

// Pairs nearer than this share of their value are not told apart by a count.
inline constexpr double kCountableGap = 1e-6;

// What a factor may take where pairs are wanted in double.
inline constexpr size_t kMaxExactFactorBytes = size_t{4} << 30;

// The entry of largest magnitude (the first, where several are) is positive.
void FixSign(Eigen::Ref<Eigen::VectorXd> vector);

// Measures the pairs [first, end) and gives the largest residual. Pairs may be
// measured by several threads at a time. REQUIRES: the eigenvalues are set.
double MeasureResiduals(const Laplacian& laplacian, int first, int end,
                        CertifiedSpectrum& spectrum);

// That the mesh has another number of eigenvalues below a shift than were
// found.
absl::Status Disagreement(double shift, int counted, int found);

// For pairs in double.
absl::Status OutOfMemory(int count, int vertices);

// Sets the bound and the count of a spectrum whose pairs are there. `known` are
// the lowest eigenvalues, as many as it has pairs or more; `count_below` counts
// at a shift or a little above it. Errors: those of `count_below`; INTERNAL
// with reason SOLVER_NOT_CONVERGED where the count disagrees.
absl::Status CountPairs(
    const Eigen::VectorXd& known,
    const std::function<absl::StatusOr<InertiaCount>(double)>& count_below,
    CertifiedSpectrum& spectrum);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_CERTIFICATE_H_
