// The kernels of dense_kernels.h, for the instructions of whichever source
// includes this. That source defines kLanes, the doubles of a register, and
// kTileRows; everything is in an unnamed namespace, so that no code compiled
// for a newer CPU can be linked into an older one's path.
//
// A tile of C, kTileRows by two registers, is kept in registers over the whole
// of k. It is the one loop behind the factorisation, the solves, the Gram
// matrices and the updates.
#ifndef MARROW_CORE_SPECTRUM_DENSE_KERNELS_BODY_H_
#define MARROW_CORE_SPECTRUM_DENSE_KERNELS_BODY_H_

#include "core/spectrum/dense_kernels.h"

namespace marrow {
namespace {

typedef double Register
    __attribute__((vector_size(8 * kLanes), aligned(8), may_alias));

// Rows one after the other.
template <typename T>
struct PlainRows {
  T* data;
  int stride;
  T* Row(int i) const { return data + static_cast<long>(i) * stride; }
};

// Rows picked by index.
template <typename T>
struct PickedRows {
  T* data;
  const int* rows;
  T* Row(int i) const { return data + static_cast<long>(rows[i]) * kBlock; }
};

template <int kRows, int kRegisters, bool kAdd, typename BRows, typename CRows>
inline void Tile(int k, const double* a, StridedMatrix A, BRows B, CRows C,
                 int i, int j) {
  Register sum[kRows][kRegisters] = {};
  for (int l = 0; l < k; ++l) {
    const double* b = B.Row(l) + j;
    Register right[kRegisters];
#pragma GCC unroll 4
    for (int v = 0; v < kRegisters; ++v)
      right[v] = *reinterpret_cast<const Register*>(b + v * kLanes);
    const double* left = a + static_cast<long>(l) * A.column;
#pragma GCC unroll 16
    for (int r = 0; r < kRows; ++r) {
      const double factor = left[static_cast<long>(r) * A.row];
#pragma GCC unroll 4
      for (int v = 0; v < kRegisters; ++v) sum[r][v] += factor * right[v];
    }
  }
#pragma GCC unroll 16
  for (int r = 0; r < kRows; ++r) {
    double* c = C.Row(i + r) + j;
#pragma GCC unroll 4
    for (int v = 0; v < kRegisters; ++v) {
      Register& out = *reinterpret_cast<Register*>(c + v * kLanes);
      out = kAdd ? out + sum[r][v] : out - sum[r][v];
    }
  }
}

// All rows of kRegisters registers' columns from j.
template <int kRegisters, bool kAdd, typename BRows, typename CRows>
inline void Columns(int m, int k, StridedMatrix A, BRows B, CRows C, int j) {
  const double* a = A.data;
  int i = 0;
  for (; i + kTileRows <= m; i += kTileRows)
    Tile<kTileRows, kRegisters, kAdd>(k, a + static_cast<long>(i) * A.row, A, B,
                                      C, i, j);
  for (; i + 4 <= m; i += 4)
    Tile<4, kRegisters, kAdd>(k, a + static_cast<long>(i) * A.row, A, B, C, i,
                              j);
  for (; i < m; ++i)
    Tile<1, kRegisters, kAdd>(k, a + static_cast<long>(i) * A.row, A, B, C, i,
                              j);
}

template <bool kAdd, typename BRows, typename CRows>
inline void Multiply(int m, int n, int k, StridedMatrix A, BRows B, CRows C) {
  int j = 0;
  for (; j + 2 * kLanes <= n; j += 2 * kLanes)
    Columns<2, kAdd>(m, k, A, B, C, j);
  for (; j + kLanes <= n; j += kLanes) Columns<1, kAdd>(m, k, A, B, C, j);
}

void MultiplyAdd(int m, int n, int k, StridedMatrix A, const double* B, int ldb,
                 double* C, int ldc) {
  Multiply<true>(m, n, k, A, PlainRows<const double>{B, ldb},
                 PlainRows<double>{C, ldc});
}

void MultiplySubtract(int m, int n, int k, StridedMatrix A, const double* B,
                      int ldb, double* C, int ldc) {
  Multiply<false>(m, n, k, A, PlainRows<const double>{B, ldb},
                  PlainRows<double>{C, ldc});
}

void ScatterSubtract(int m, int k, StridedMatrix A, const double* B, double* C,
                     const int* c_rows) {
  Multiply<false>(m, kBlock, k, A, PlainRows<const double>{B, kBlock},
                  PickedRows<double>{C, c_rows});
}

void GatherSubtract(int m, int k, StridedMatrix A, const double* B,
                    const int* b_rows, double* C) {
  Multiply<false>(m, kBlock, k, A, PickedRows<const double>{B, b_rows},
                  PlainRows<double>{C, kBlock});
}

// Row i of X less the multiples of rows from `begin` up to `end`.
inline void SubtractRows(int begin, int end, const double* factors, int stride,
                         double* X, int i) {
  constexpr int kRegisters = kBlock / kLanes;
  Register sum[kRegisters];
  Register* row =
      reinterpret_cast<Register*>(X + static_cast<long>(i) * kBlock);
#pragma GCC unroll 8
  for (int v = 0; v < kRegisters; ++v) sum[v] = row[v];
  for (int l = begin; l < end; ++l) {
    const Register* other =
        reinterpret_cast<const Register*>(X + static_cast<long>(l) * kBlock);
    const double factor = factors[static_cast<long>(l) * stride];
#pragma GCC unroll 8
    for (int v = 0; v < kRegisters; ++v) sum[v] -= factor * other[v];
  }
#pragma GCC unroll 8
  for (int v = 0; v < kRegisters; ++v) row[v] = sum[v];
}

// Triangles are solved in steps of this many rows; what is outside of them is
// a product of matrices.
constexpr int kStep = 8;

void LowerSolve(int width, const double* panel, int stride, double* X) {
  for (int begin = 0; begin < width; begin += kStep) {
    const int end = begin + kStep < width ? begin + kStep : width;
    for (int i = begin + 1; i < end; ++i)
      SubtractRows(begin, i, panel + i, stride, X, i);
    if (end == width) return;
    const double* block = panel + static_cast<long>(begin) * stride + end;
    MultiplySubtract(width - end, kBlock, end - begin, {block, 1, stride},
                     X + begin * kBlock, kBlock, X + end * kBlock, kBlock);
  }
}

void UpperSolve(int width, const double* panel, int stride, double* X) {
  for (int begin = (width - 1) / kStep * kStep; begin >= 0; begin -= kStep) {
    const int end = begin + kStep < width ? begin + kStep : width;
    const double* rows = panel + static_cast<long>(begin) * stride;
    if (end < width)
      MultiplySubtract(end - begin, kBlock, width - end,
                       {rows + end, stride, 1}, X + end * kBlock, kBlock,
                       X + begin * kBlock, kBlock);
    for (int i = end - 2; i >= begin; --i)
      SubtractRows(i + 1, end, panel + static_cast<long>(i) * stride, 1, X, i);
  }
}

constexpr DenseKernels KernelsNamed(const char* name) {
  return {&MultiplyAdd,
          &MultiplySubtract,
          &ScatterSubtract,
          &GatherSubtract,
          &LowerSolve,
          &UpperSolve,
          name};
}

}  // namespace
}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_DENSE_KERNELS_BODY_H_
