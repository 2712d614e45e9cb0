#include "core/spectrum/lanczos_basis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace marrow {
namespace {

// Rows worked on at once: what the blocks have of them stays in the cache.
constexpr int kChunk = 512;
// Squared lengths below this share are rounding of what was subtracted, and
// those below the second of other columns of the block.
constexpr double kVanished = 1e-26;
constexpr double kDependent = 1e-13;

uint64_t Mix(uint64_t x) {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

}  // namespace

double* LanczosBasis::Block(int index) {
  while (static_cast<int>(blocks_.size()) <= index)
    blocks_.emplace_back(static_cast<size_t>(n_) * kBlock);
  return blocks_[index].data();
}

void LanczosBasis::FillRandomly(double* W, uint64_t seed) const {
  const uint64_t base = Mix(seed);
  const size_t size = static_cast<size_t>(n_) * kBlock;
  for (size_t i = 0; i < size; ++i)
    W[i] = static_cast<double>(static_cast<int64_t>(Mix(base + i))) * 0x1p-63;
}

RowMajorMatrix LanczosBasis::Project(const double* W) const {
  RowMajorMatrix C = RowMajorMatrix::Zero(dimension(), kBlock);
  for (int begin = 0; begin < n_; begin += kChunk) {
    const int rows = std::min(kChunk, n_ - begin);
    const size_t at = static_cast<size_t>(begin) * kBlock;
    for (int j = 0; j < num_blocks_; ++j)
      kernels_.multiply_add(kBlock, kBlock, rows,
                            {blocks_[j].data() + at, 1, kBlock}, W + at, kBlock,
                            C.data() + j * kBlock * kBlock, kBlock);
  }
  return C;
}

RowMajorMatrix LanczosBasis::SubtractAndGram(const RowMajorMatrix& C,
                                             double* W) const {
  RowMajorMatrix gram = RowMajorMatrix::Zero(kBlock, kBlock);
  for (int begin = 0; begin < n_; begin += kChunk) {
    const int rows = std::min(kChunk, n_ - begin);
    const size_t at = static_cast<size_t>(begin) * kBlock;
    for (int j = 0; j < num_blocks_; ++j)
      kernels_.multiply_subtract(rows, kBlock, kBlock,
                                 {blocks_[j].data() + at, kBlock, 1},
                                 C.data() + j * kBlock * kBlock, kBlock, W + at,
                                 kBlock);
    kernels_.multiply_add(kBlock, kBlock, rows, {W + at, 1, kBlock}, W + at,
                          kBlock, gram.data(), kBlock);
  }
  return gram;
}

void LanczosBasis::MultiplyInPlace(const RowMajorMatrix& B, double* W) const {
  alignas(64) double copy[kChunk * kBlock];
  for (int begin = 0; begin < n_; begin += kChunk) {
    const int rows = std::min(kChunk, n_ - begin);
    double* at = W + static_cast<size_t>(begin) * kBlock;
    const size_t bytes = sizeof(double) * rows * kBlock;
    std::memcpy(copy, at, bytes);
    std::memset(at, 0, bytes);
    kernels_.multiply_add(rows, kBlock, kBlock, {copy, kBlock, 1}, B.data(),
                          kBlock, at, kBlock);
  }
}

void LanczosBasis::ReplaceColumns(const std::vector<bool>& which,
                                  const double* Z, double* W) const {
  for (int c = 0; c < kBlock; ++c) {
    if (!which[c]) continue;
    for (size_t i = c; i < static_cast<size_t>(n_) * kBlock; i += kBlock)
      W[i] = Z[i];
  }
}

void LanczosBasis::Combine(const RowMajorMatrix& coefficients,
                           double* Y) const {
  for (int begin = 0; begin < n_; begin += kChunk) {
    const int rows = std::min(kChunk, n_ - begin);
    const size_t at = static_cast<size_t>(begin) * kBlock;
    std::memset(Y + at, 0, sizeof(double) * rows * kBlock);
    for (int j = 0; j < num_blocks_; ++j)
      kernels_.multiply_add(rows, kBlock, kBlock,
                            {blocks_[j].data() + at, kBlock, 1},
                            coefficients.data() + j * kBlock * kBlock, kBlock,
                            Y + at, kBlock);
  }
}

Orthonormaliser MakeOrthonormaliser(const RowMajorMatrix& gram,
                                    const Eigen::VectorXd& size) {
  // Columns are scaled to length 1 first, so that a short one is not taken for
  // a dependent one.
  Eigen::VectorXd scale(kBlock);
  for (int c = 0; c < kBlock; ++c)
    scale[c] = gram(c, c) > kVanished * size[c] && gram(c, c) > 0
                   ? 1 / std::sqrt(gram(c, c))
                   : 0;
  const Eigen::MatrixXd scaled =
      scale.asDiagonal() * gram * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Orthonormaliser result;
  result.B = RowMajorMatrix::Zero(kBlock, kBlock);
  result.R = RowMajorMatrix::Zero(kBlock, kBlock);
  result.missing.assign(kBlock, false);
  for (int c = 0; c < kBlock; ++c) {
    const double s = eigen.eigenvalues()[c];
    if (!(s > kDependent * kBlock)) {
      result.missing[c] = true;
      result.complete = false;
      continue;
    }
    const Eigen::VectorXd u = eigen.eigenvectors().col(c);
    result.B.col(c) = scale.cwiseProduct(u) / std::sqrt(s);
    for (int k = 0; k < kBlock; ++k)
      if (scale[k] > 0) result.R(c, k) = std::sqrt(s) * u[k] / scale[k];
  }
  return result;
}

}  // namespace marrow
