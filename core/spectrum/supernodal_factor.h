// L D L' of a shifted sparse matrix, and solves with blocks of vectors.
#ifndef MARROW_CORE_SPECTRUM_SUPERNODAL_FACTOR_H_
#define MARROW_CORE_SPECTRUM_SUPERNODAL_FACTOR_H_

#include <cstddef>
#include <vector>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/aligned_buffer.h"
#include "core/spectrum/supernodal_structure.h"
#include "core/spectrum/team.h"

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
  // it. May throw std::bad_alloc.
  absl::Status Compute(double shift, Team& team, const CancelToken& cancel);

  double shift() const { return shift_; }
  // By Sylvester's law of inertia, how many eigenvalues of A are below shift().
  int negative_pivots() const { return negative_pivots_; }

  // X = (A - shift I)^-1 X, a block of n rows in the structure's order. Errors:
  // CANCELLED, and X is of no use then.
  absl::Status Solve(double* X, Team& team, const CancelToken& cancel) const;

 private:
  using Supernode = SupernodalStructure::Supernode;

  // What a thread needs to eliminate a run of supernodes.
  struct Workspace {
    std::vector<double> stack;   // updates on their way up
    std::vector<int> waiting;    // whose they are
    std::vector<double> panel;   // of the supernode that is eliminated
    std::vector<double> front;   // the update that is being made
    std::vector<double> scaled;  // a block of rows of L'
    int negative_pivots = 0;
    absl::Status status;
  };

  absl::Status EliminateRun(int begin, int end, Workspace& work, Team& team,
                            const CancelToken& cancel);
  void Assemble(int index, Workspace& work);
  void AddUpdate(const Supernode& child, const double* update,
                 const Supernode& parent, Workspace& work) const;
  absl::Status Eliminate(const Supernode& node, Workspace& work, Team& team,
                         const CancelToken& cancel);
  absl::Status EliminateStep(const Supernode& node, int begin, int end,
                             int block_end, Workspace& work);
  void UpdateBelow(const Supernode& node, int begin, int end, Workspace& work,
                   Team& team);
  void InvertTriangle(const Supernode& node, int begin, int end,
                      Workspace& work, Team& team) const;
  double* Pack(const Supernode& node, int begin, int end, const double* scaled,
               double* out) const;
  void PushUpdate(int index, Workspace& work) const;
  // `top` is where the rows of the top are, as if row 0 were there too.
  void SolveDown(const Supernode& node, double* X, double* top) const;
  void SolveUp(const Supernode& node, double* X) const;

  const SupernodalStructure& structure_;
  const DenseKernels& kernels_;
  double shift_ = 0;
  int negative_pivots_ = 0;
  AlignedBuffer packed_;
  std::vector<double> inverse_pivots_;
  std::vector<Workspace> branches_;
  Workspace top_;
};

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SUPERNODAL_FACTOR_H_
