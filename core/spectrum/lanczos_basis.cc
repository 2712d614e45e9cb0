#include "core/spectrum/lanczos_basis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace marrow {
namespace {

// Rows worked on at once: what the blocks have of them stays in the cache.
constexpr int kChunk = 256;
// The same for all blocks of a basis.
constexpr int kSmallChunk = 64;
constexpr size_t kBlockEntries = size_t{kBlock} * kBlock;
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

// Rows are divided in as many parts whatever the team, so that sums over them
// are added in the same order.
constexpr int kParts = 8;

int PartBegin(int n, int part) {
  return static_cast<int>(static_cast<int64_t>(n) * part / kParts);
}

// body(rows, offset of the first of them in a block), until cancelled.
template <typename Body>
void ForChunks(int n, int part, int chunk, const CancelToken& cancel,
               const Body& body) {
  const int end = PartBegin(n, part + 1);
  for (int begin = PartBegin(n, part); begin < end && !cancel.IsCancelled();
       begin += chunk)
    body(std::min(chunk, end - begin), static_cast<size_t>(begin) * kBlock);
}

RowMajorMatrix Sum(const std::vector<RowMajorMatrix>& parts) {
  RowMajorMatrix sum = parts[0];
  for (size_t i = 1; i < parts.size(); ++i) sum += parts[i];
  return sum;
}

}  // namespace

double* LanczosBasis::Block(int index) {
  while (static_cast<int>(blocks_.size()) <= index)
    blocks_.emplace_back(static_cast<size_t>(n_) * kBlock);
  return blocks_[index].data();
}

void LanczosBasis::FillRandomly(double* W, uint64_t seed) const {
  const uint64_t base = Mix(seed);
  team_.For(kParts, [&](int part) {
    const size_t end = static_cast<size_t>(PartBegin(n_, part + 1)) * kBlock;
    for (size_t i = static_cast<size_t>(PartBegin(n_, part)) * kBlock; i < end;
         ++i)
      W[i] = static_cast<double>(static_cast<int64_t>(Mix(base + i))) * 0x1p-63;
  });
}

void LanczosBasis::Copy(int index, double* W) const {
  team_.For(kParts, [&](int part) {
    ForChunks(n_, part, kChunk, CancelToken(), [&](int rows, size_t at) {
      std::memcpy(W + at, blocks_[index].data() + at,
                  sizeof(double) * rows * kBlock);
    });
  });
}

RowMajorMatrix LanczosBasis::Project(int first, const double* W,
                                     const CancelToken& cancel) const {
  std::vector<RowMajorMatrix> sums(kParts,
                                   RowMajorMatrix::Zero(dimension(), kBlock));
  team_.For(kParts, [&](int part) {
    ForChunks(n_, part, kChunk, cancel, [&](int rows, size_t at) {
      for (int j = first; j < num_blocks_; ++j)
        kernels_.multiply_add(
            kBlock, kBlock, rows, {blocks_[j].data() + at, 1, kBlock}, W + at,
            kBlock, sums[part].data() + kBlockEntries * j, kBlock);
    });
  });
  return Sum(sums);
}

RowMajorMatrix LanczosBasis::SubtractAndGram(int first, const RowMajorMatrix& C,
                                             double* W,
                                             const CancelToken& cancel) const {
  std::vector<RowMajorMatrix> sums(kParts,
                                   RowMajorMatrix::Zero(kBlock, kBlock));
  const std::vector<const double*> V = Pointers();
  team_.For(kParts, [&](int part) {
    ForChunks(n_, part, kChunk, cancel, [&](int rows, size_t at) {
      kernels_.blocks_subtract(rows, num_blocks_ - first, V.data() + first, at,
                               C.data() + kBlockEntries * first, kBlock,
                               W + at);
      kernels_.multiply_add(kBlock, kBlock, rows, {W + at, 1, kBlock}, W + at,
                            kBlock, sums[part].data(), kBlock);
    });
  });
  return Sum(sums);
}

// The overlaps are so small that what is orthonormal stays so without them.
absl::Status LanczosBasis::SeparateLastTwo(const CancelToken& cancel) {
  const int before = num_blocks_ - 2;
  const std::vector<const double*> V = Pointers();
  std::array<double*, 2> last{Block(before), Block(before + 1)};
  std::array<std::vector<RowMajorMatrix>, 2> sums;
  for (auto& sum : sums)
    sum.assign(kParts,
               RowMajorMatrix::Zero(Eigen::Index{before} * kBlock, kBlock));
  // What is read of a block serves both.
  team_.For(kParts, [&](int part) {
    ForChunks(n_, part, kChunk, cancel, [&](int rows, size_t at) {
      for (int j = 0; j < before; ++j)
        for (int w = 0; w < 2; ++w)
          kernels_.multiply_add(
              kBlock, kBlock, rows, {V[j] + at, 1, kBlock}, last[w] + at,
              kBlock, sums[w][part].data() + kBlockEntries * j, kBlock);
    });
  });
  const std::array<RowMajorMatrix, 2> C{Sum(sums[0]), Sum(sums[1])};
  team_.For(kParts, [&](int part) {
    ForChunks(n_, part, kChunk, cancel, [&](int rows, size_t at) {
      for (int w = 0; w < 2; ++w)
        kernels_.blocks_subtract(rows, before, V.data(), at, C[w].data(),
                                 kBlock, last[w] + at);
    });
  });
  return cancel.Check();
}

std::vector<const double*> LanczosBasis::Pointers() const {
  std::vector<const double*> pointers;
  for (const AlignedBuffer& block : blocks_) pointers.push_back(block.data());
  return pointers;
}

void LanczosBasis::MultiplyInPlace(const RowMajorMatrix& B, double* W) const {
  team_.For(kParts, [&](int part) {
    alignas(64) double copy[kChunk * kBlock];
    ForChunks(n_, part, kChunk, CancelToken(), [&](int rows, size_t at) {
      const size_t bytes = sizeof(double) * rows * kBlock;
      std::memcpy(copy, W + at, bytes);
      std::memset(W + at, 0, bytes);
      kernels_.multiply_add(rows, kBlock, kBlock, {copy, kBlock, 1}, B.data(),
                            kBlock, W + at, kBlock);
    });
  });
}

void LanczosBasis::ReplaceColumns(const std::vector<bool>& which,
                                  const double* Z, double* W) const {
  for (int c = 0; c < kBlock; ++c) {
    if (!which[c]) continue;
    for (size_t i = c; i < static_cast<size_t>(n_) * kBlock; i += kBlock)
      W[i] = Z[i];
  }
}

absl::Status LanczosBasis::Combine(const RowMajorMatrix& coefficients,
                                   std::span<double* const> Y,
                                   const CancelToken& cancel) const {
  const int ldb = static_cast<int>(coefficients.cols());
  const std::vector<const double*> V = Pointers();
  team_.For(kParts, [&](int part) {
    ForChunks(n_, part, kSmallChunk, cancel, [&](int rows, size_t at) {
      for (size_t b = 0; b < Y.size(); ++b) {
        std::memset(Y[b] + at, 0, sizeof(double) * rows * kBlock);
        kernels_.blocks_add(rows, num_blocks_, V.data(), at,
                            coefficients.data() + b * kBlock, ldb, Y[b] + at);
      }
    });
  });
  return cancel.Check();
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
  const Eigen::MatrixXd scaled = scale.asDiagonal() * gram * scale.asDiagonal();
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
    result.magnification =
        std::max(result.magnification,
                 result.B.col(c).norm() * std::sqrt(size.maxCoeff()));
    for (int k = 0; k < kBlock; ++k)
      if (scale[k] > 0) result.R(c, k) = std::sqrt(s) * u[k] / scale[k];
  }
  return result;
}

}  // namespace marrow
