// The basis of a block Lanczos process, and the dense work on it.
#ifndef MARROW_CORE_SPECTRUM_LANCZOS_BASIS_H_
#define MARROW_CORE_SPECTRUM_LANCZOS_BASIS_H_

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/aligned_buffer.h"
#include "core/spectrum/dense_kernels.h"
#include "core/spectrum/team.h"

namespace marrow {

using RowMajorMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Orthonormal blocks of kBlock vectors of n entries each, kept in `blocks`,
// which grows as needed and is the caller's. The same bytes whatever the team.
class LanczosBasis {
 public:
  LanczosBasis(int n, std::vector<AlignedBuffer>& blocks, Team& team)
      : n_(n), blocks_(blocks), team_(team), kernels_(Kernels()) {}

  int num_blocks() const { return num_blocks_; }
  int dimension() const { return num_blocks_ * kBlock; }
  // Block `index` counted from 0; one may ask for blocks beyond num_blocks():
  // they are scratch.
  double* Block(int index);

  void FillRandomly(double* W, uint64_t seed) const;
  void Copy(int index, double* W) const;

  // What was W in terms of the basis: W = V * projection + Q * remainder, Q the
  // new block.
  struct Growth {
    RowMajorMatrix projection;  // dimension() before x kBlock
    RowMajorMatrix remainder;   // kBlock x kBlock
    bool is_to_all = false;     // the block is orthogonal to all before it
  };
  // Makes of W = Block(num_blocks()) the next block of the basis, orthogonal to
  // the last two, and to all where rounding makes it necessary or where
  // `wants_all(growth)`, asked when `growth` is about what it will be, says so.
  // Directions that W does not have are filled by `fill(Z)`, which writes a
  // block of vectors to be used instead and returns a status. Errors:
  // CANCELLED; those of `fill`.
  template <typename Fill, typename WantsAll>
  absl::Status Append(const Fill& fill, const WantsAll& wants_all,
                      const CancelToken& cancel, Growth& growth);

  // Makes the last two blocks orthogonal to those before them, with which they
  // overlap by little: the square of it is nothing. Errors: CANCELLED.
  absl::Status SeparateLastTwo(const CancelToken& cancel);

  // Y = V * coefficients, a block for every kBlock columns of these. Errors:
  // CANCELLED.
  absl::Status Combine(const RowMajorMatrix& coefficients,
                       std::span<double* const> Y,
                       const CancelToken& cancel) const;

 private:
  // V'W, and W -= V C and then W'W, for V the blocks from `first` on; C has
  // rows for all blocks. Anything, once cancelled.
  RowMajorMatrix Project(int first, const double* W,
                         const CancelToken& cancel) const;
  RowMajorMatrix SubtractAndGram(int first, const RowMajorMatrix& C, double* W,
                                 const CancelToken& cancel) const;
  std::vector<const double*> Pointers() const;
  void MultiplyInPlace(const RowMajorMatrix& B, double* W) const;
  void ReplaceColumns(const std::vector<bool>& which, const double* Z,
                      double* W) const;

  const int n_;
  std::vector<AlignedBuffer>& blocks_;
  Team& team_;
  const DenseKernels& kernels_;
  int num_blocks_ = 0;
};

// W B has orthonormal columns where W'W = `gram`, but for those that are
// `missing`, which are zero; W = (W B) R.
struct Orthonormaliser {
  RowMajorMatrix B;
  RowMajorMatrix R;
  std::vector<bool> missing;
  bool complete = true;
  // How much longer a column of W B is than what rounding left of W in it.
  double magnification = 0;
};
// A block is orthogonal, to those that it was made so to, to about this times
// the rounding unit.
inline constexpr double kMostMagnification = 1e5;
// A fill that has something new is all it takes, as nearly any has.
inline constexpr int kMostFills = 2;
// Below this one pass does.
inline constexpr double kLittleMagnification = 100;
// `size` is the squared length that each column had before it was projected:
// what is tiny beside it is rounding.
Orthonormaliser MakeOrthonormaliser(const RowMajorMatrix& gram,
                                    const Eigen::VectorXd& size);

template <typename Fill, typename WantsAll>
absl::Status LanczosBasis::Append(const Fill& fill, const WantsAll& wants_all,
                                  const CancelToken& cancel, Growth& growth) {
  double* W = Block(num_blocks_);
  growth.remainder = RowMajorMatrix::Identity(kBlock, kBlock);
  growth.projection = RowMajorMatrix::Zero(dimension(), kBlock);
  growth.is_to_all = num_blocks_ <= 2;
  const int near = std::max(0, num_blocks_ - 2);
  // The first pass takes away nearly all, and often is enough. What is left is
  // too small for the second to be led astray by vectors of the basis that
  // overlap a little. The others follow a fill.
  int passes = 2, first = near, fills = 0;
  for (int pass = 0; pass < passes; ++pass) {
    const RowMajorMatrix C = Project(first, W, cancel);
    const RowMajorMatrix gram = SubtractAndGram(first, C, W, cancel);
    if (cancel.IsCancelled()) return cancel.Check();
    const Orthonormaliser q = MakeOrthonormaliser(
        gram, C.colwise().squaredNorm().transpose() + gram.diagonal());
    growth.projection += C * growth.remainder;
    growth.remainder = q.R * growth.remainder;
    MultiplyInPlace(q.B, W);
    growth.is_to_all = growth.is_to_all || !q.complete ||
                       q.magnification > kMostMagnification ||
                       (pass == 0 && wants_all(growth));
    first = growth.is_to_all ? 0 : near;
    if (pass == 0 && q.complete && first == near &&
        q.magnification < kLittleMagnification)
      break;
    if (q.complete || fills++ == kMostFills) continue;
    passes = pass + 3;
    double* Z = Block(num_blocks_ + 1);
    if (absl::Status status = fill(Z); !status.ok()) return status;
    ReplaceColumns(q.missing, Z, W);
  }
  ++num_blocks_;
  return absl::OkStatus();
}

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_LANCZOS_BASIS_H_
