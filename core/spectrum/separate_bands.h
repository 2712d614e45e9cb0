// Pairs of one band beside those of the bands before it.
#ifndef MARROW_CORE_SPECTRUM_SEPARATE_BANDS_H_
#define MARROW_CORE_SPECTRUM_SEPARATE_BANDS_H_

#include <Eigen/Core>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// Vectors of one band are orthonormal; those of two overlap by about the
// residuals that were left in them. `residuals`, in units of lambda, are those
// of the first columns of `vectors`, which are there; `mass` is the diagonal of
// M. Makes those from `begin` on M-orthogonal to the kBandReach before it, if
// either has a residual above `loose`. What is taken away is so little that
// those from `begin` on stay orthonormal among themselves, to its square.
// Anything, once cancelled. Time:
// O(n kBandReach) a column with such a residual.
inline constexpr Eigen::Index kBandReach = 64;
void SeparateBands(const Eigen::VectorXd& mass,
                   const std::vector<double>& residuals, double loose,
                   Eigen::Index begin, const CancelToken& cancel,
                   EigenvectorMatrix& vectors);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SEPARATE_BANDS_H_
