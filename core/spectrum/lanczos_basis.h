// The basis of a block Lanczos process, and the dense work on it.
#ifndef MARROW_CORE_SPECTRUM_LANCZOS_BASIS_H_
#define MARROW_CORE_SPECTRUM_LANCZOS_BASIS_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/aligned_buffer.h"
#include "core/spectrum/dense_kernels.h"

namespace marrow {

using RowMajorMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Orthonormal blocks of kBlock vectors of n entries each, kept in `blocks`,
// which grows as needed and is the caller's.
class LanczosBasis {
 public:
  LanczosBasis(int n, std::vector<AlignedBuffer>& blocks)
      : n_(n), blocks_(blocks), kernels_(Kernels()) {}

  int num_blocks() const { return num_blocks_; }
  int dimension() const { return num_blocks_ * kBlock; }
  // Block `index` counted from 0; one may ask for blocks beyond num_blocks():
  // they are scratch.
  double* Block(int index);

  void FillRandomly(double* W, uint64_t seed) const;

  // What was W in terms of the basis: W = V * projection + Q * remainder, Q the
  // new block.
  struct Growth {
    RowMajorMatrix projection;  // dimension() before x kBlock
    RowMajorMatrix remainder;   // kBlock x kBlock
  };
  // Makes of W = Block(num_blocks()) the next block of the basis. Directions
  // that W does not have are filled by `fill(Z)`, which writes a block of
  // vectors to be used instead. Errors: CANCELLED.
  template <typename Fill>
  absl::Status Append(const Fill& fill, const CancelToken& cancel,
                      Growth& growth);

  // Y = V * coefficients; coefficients are dimension() x kBlock.
  void Combine(const RowMajorMatrix& coefficients, double* Y) const;

 private:
  // W -= V C and, of what is left, W'W.
  RowMajorMatrix SubtractAndGram(const RowMajorMatrix& C, double* W) const;
  RowMajorMatrix Project(const double* W) const;
  void MultiplyInPlace(const RowMajorMatrix& B, double* W) const;
  void ReplaceColumns(const std::vector<bool>& which, const double* Z,
                      double* W) const;

  const int n_;
  std::vector<AlignedBuffer>& blocks_;
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
};
// `size` is the squared length that each column had before it was projected:
// what is tiny beside it is rounding.
Orthonormaliser MakeOrthonormaliser(const RowMajorMatrix& gram,
                                    const Eigen::VectorXd& size);

template <typename Fill>
absl::Status LanczosBasis::Append(const Fill& fill, const CancelToken& cancel,
                                  Growth& growth) {
  double* W = Block(num_blocks_);
  // Twice is enough (Kahan and Parlett), three times after a fill.
  int passes = 2;
  growth.remainder = RowMajorMatrix::Identity(kBlock, kBlock);
  growth.projection = RowMajorMatrix::Zero(dimension(), kBlock);
  for (int pass = 0; pass < passes; ++pass) {
    if (cancel.IsCancelled()) return cancel.Check();
    const RowMajorMatrix C = Project(W);
    if (cancel.IsCancelled()) return cancel.Check();
    const RowMajorMatrix gram = SubtractAndGram(C, W);
    const Eigen::VectorXd size =
        C.colwise().squaredNorm().transpose() + gram.diagonal();
    const Orthonormaliser q = MakeOrthonormaliser(gram, size);
    growth.projection += C * growth.remainder;
    growth.remainder = q.R * growth.remainder;
    MultiplyInPlace(q.B, W);
    if (q.complete || pass > 1) continue;
    passes = 4;
    double* Z = Block(num_blocks_ + 1);
    fill(Z);
    ReplaceColumns(q.missing, Z, W);
  }
  ++num_blocks_;
  return absl::OkStatus();
}

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_LANCZOS_BASIS_H_
