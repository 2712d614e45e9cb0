// Block Lanczos steps with the inverse of a shifted matrix.
#ifndef MARROW_CORE_SPECTRUM_LANCZOS_PROCESS_H_
#define MARROW_CORE_SPECTRUM_LANCZOS_PROCESS_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/lanczos_basis.h"
#include "core/spectrum/overlap_estimate.h"
#include "core/spectrum/supernodal_factor.h"
#include "core/spectrum/team.h"

namespace marrow {

// Grows a basis V with (A - shift I)^-1 V = V T + Q R E', where Q is its last
// block. Not thread safe; the same bytes whatever the team.
class LanczosProcess {
 public:
  // All must outlive this. Another `seed` is another start.
  LanczosProcess(int n, const SupernodalFactor& factor, uint64_t seed,
                 std::vector<AlignedBuffer>& blocks, Team& team,
                 const CancelToken& cancel)
      : factor_(factor),
        team_(team),
        cancel_(cancel),
        basis_(n, blocks, team),
        seed_(seed) {}

  // Begins with the solutions of a random block. Errors: CANCELLED.
  absl::Status Start();
  // Takes the last block of the basis through the operator. Errors: CANCELLED.
  absl::Status Step();

  LanczosBasis& basis() { return basis_; }
  const LanczosBasis& basis() const { return basis_; }
  const Eigen::MatrixXd& T() const { return T_; }
  const Eigen::MatrixXd& R() const { return R_; }

 private:
  absl::Status FillAnew(double* Z);
  absl::Status Append(LanczosBasis::Growth& growth);

  const SupernodalFactor& factor_;
  Team& team_;
  const CancelToken& cancel_;
  LanczosBasis basis_;
  OverlapEstimate overlaps_;
  uint64_t seed_;
  Eigen::MatrixXd T_;
  Eigen::MatrixXd R_;
};

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_LANCZOS_PROCESS_H_
