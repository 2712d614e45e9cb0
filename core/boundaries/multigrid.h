// Steps of heat flow on meshes of any size in time that grows with the mesh.
#ifndef MARROW_CORE_BOUNDARIES_MULTIGRID_H_
#define MARROW_CORE_BOUNDARIES_MULTIGRID_H_

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/operators/laplacian.h"

namespace marrow {

// Solves with A = M + c L of one mesh for any c >= 0: conjugate gradients,
// preconditioned by a cycle over ever coarser levels (smoothed aggregation:
// Vanek, Mandel and Brezina 1996), which take some ten steps however large the
// mesh and wide the step of heat. Deterministic. Not thread safe.
class Multigrid {
 public:
  explicit Multigrid(const Laplacian& laplacian);

  // Chooses A.
  void SetStep(double c);

  // Solves A x = b from the guess x, to a residual of `tolerance` |b|; answers
  // in how many steps. Stops early, x being anything, once `cancel` is.
  int Solve(const Eigen::VectorXd& b, double tolerance,
            const CancelToken& cancel, Eigen::VectorXd& x) const;

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  struct Level {
    Matrix L, M, A;
    Matrix P;  // values of the next, coarser level -> values of this one
  };

  // About A^-1 b, from that level on.
  Eigen::VectorXd Cycle(size_t level, const Eigen::VectorXd& b) const;

  std::vector<Level> levels_;  // the finest first
  Eigen::LLT<Eigen::MatrixXd> coarsest_;
};

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_MULTIGRID_H_
