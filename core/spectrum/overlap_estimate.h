// How far a Lanczos basis is from orthonormal, without looking at its vectors.
#ifndef MARROW_CORE_SPECTRUM_OVERLAP_ESTIMATE_H_
#define MARROW_CORE_SPECTRUM_OVERLAP_ESTIMATE_H_

#include <Eigen/Core>

#include "core/spectrum/lanczos_basis.h"

namespace marrow {

// Follows Omega_j = V'Q_j, the overlap of block j with the blocks before it,
// where block j + 1 was made orthogonal to the last two of them alone. With
// Op Q_j = V P_j + Q_(j+1) R_j and Op symmetric,
//   Omega_(j+1) R_j = T Omega_j - Omega_(j-1) P_(j,j-1) - Omega_j P_(j,j),
// but for rounding, for the blocks before the last two (Grimes, Lewis and Simon
// 1994, whose bounds on the norms of this are as much too large as they are
// quick to find). What rounding adds at a step shows in P_(j,j), which would be
// symmetric without it: little where the operator is a product, much where
// factors are bad. Not thread safe.
class OverlapEstimate {
 public:
  // The overlap that the next block has. `T` is the projected operator without
  // the block's column.
  Eigen::MatrixXd Next(const Eigen::MatrixXd& T,
                       const LanczosBasis::Growth& growth) const;

  // To be called for every block, before the next two.
  void NoteRounding(const LanczosBasis::Growth& growth);
  // The next block has this overlap, or none but rounding.
  void Append(Eigen::MatrixXd overlap);
  void AppendOrthogonal(Eigen::Index rows);

 private:
  Eigen::MatrixXd last_, before_;  // Omega_j and Omega_(j-1)
  double rounding_ = 0;            // the most of any step
};

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_OVERLAP_ESTIMATE_H_
