// L D L' of a shifted sparse matrix, and solves with blocks of vectors.
#ifndef MARROW_CORE_SPECTRUM_SUPERNODAL_FACTOR_H_
#define MARROW_CORE_SPECTRUM_SUPERNODAL_FACTOR_H_

#include <cstddef>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/aligned_buffer.h"
#include "core/spectrum/supernodal_structure.h"

namespace marrow {

// Keeps its memory from one shift to the next. Not thread safe, but Solve() is
// const and may run on several threads.
class SupernodalFactor {
 public:
  // `structure` must outlive this. May throw std::bad_alloc.
  explicit SupernodalFactor(const SupernodalStructure& structure);

  // Factorises A - shift I without pivoting. Errors: CANCELLED;
  // FAILED_PRECONDITION where a pivot vanishes, so `shift` is, but for
  // rounding, an eigenvalue of A or of a leading part of it: try a shift beside
  // it.
  absl::Status Compute(double shift, const CancelToken& cancel);

  double shift() const { return shift_; }
  // By Sylvester's law of inertia, how many eigenvalues of A are below shift().
  int negative_pivots() const { return negative_pivots_; }

  // X = (A - shift I)^-1 X for each of the blocks, which have n rows of kBlock
  // in the structure's order. Two blocks at once take less than twice the time
  // of one.
  void Solve(std::span<double* const> blocks) const;

 private:
  using Supernode = SupernodalStructure::Supernode;

  void Assemble(int index);
  void AddUpdate(const Supernode& child, const double* update,
                 const Supernode& parent, double* panel, double* front) const;
  absl::Status Eliminate(const Supernode& node, double* panel, double* front,
                         const CancelToken& cancel);
  absl::Status EliminateStep(const Supernode& node, double* panel, int begin,
                             int end, int block_end, double* scaled);
  void UpdateBelow(const Supernode& node, double* panel, double* front,
                   int begin, int end, const double* scaled) const;
  void SolveDown(const Supernode& node, double* X) const;
  void SolveUp(const Supernode& node, double* X) const;
  void PushUpdate(const Supernode& node, const double* front);

  const SupernodalStructure& structure_;
  const DenseKernels& kernels_;
  double shift_ = 0;
  int negative_pivots_ = 0;
  AlignedBuffer panels_;  // rows of L', unit diagonals implied
  AlignedBuffer stack_;   // updates on their way up
  AlignedBuffer front_;   // the update that is being made
  AlignedBuffer scaled_;  // a block of rows of L'
  std::vector<double> inverse_pivots_;
  std::vector<int> waiting_;  // the supernodes whose updates are on the stack
  size_t stack_top_ = 0;
};

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SUPERNODAL_FACTOR_H_
