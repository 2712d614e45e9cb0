// The kernels of dense_kernels.h, for the instructions of whichever source
// includes this. That source defines kLanes, the doubles of a register, and
// kTileRows; everything is in an unnamed namespace, so that no code compiled
// for a newer CPU can be linked into an older one's path.
//
// A tile of C, kTileRows by two registers, is kept in registers over the whole
// of k. It is the one loop behind the factorisation, the Gram matrices and the
// updates; solves have their own, which read a factor in one go.
#ifndef MARROW_CORE_SPECTRUM_DENSE_KERNELS_BODY_H_
#define MARROW_CORE_SPECTRUM_DENSE_KERNELS_BODY_H_

#include "core/spectrum/dense_kernels.h"

// A tile is of so few rows and columns that an int holds any place in it.
// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result,google-build-namespaces)
namespace marrow {
namespace {

typedef double Register
    __attribute__((vector_size(8 * kLanes), aligned(8), may_alias));

// Registers of a row of a block, and tiles of rows worked on at once: enough
// sums that none waits for the one before.
constexpr int kRow = kBlock / kLanes;
constexpr int kTogether = kRow == 1 ? 2 : 1;

template <int kRows, int kRegisters, bool kAdd>
inline void Tile(int k, const double* a, StridedMatrix A, const double* B,
                 int ldb, double* C, int ldc) {
  Register sum[kRows][kRegisters] = {};
  for (int l = 0; l < k; ++l) {
    const double* b = B + static_cast<long>(l) * ldb;
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
    double* c = C + static_cast<long>(r) * ldc;
#pragma GCC unroll 4
    for (int v = 0; v < kRegisters; ++v) {
      Register& out = *reinterpret_cast<Register*>(c + v * kLanes);
      out = kAdd ? out + sum[r][v] : out - sum[r][v];
    }
  }
}

// All rows of kRegisters registers' columns.
template <int kRegisters, bool kAdd>
inline void Columns(int m, int k, StridedMatrix A, const double* B, int ldb,
                    double* C, int ldc) {
  const auto tile = [&]<int kRows>(int i) {
    Tile<kRows, kRegisters, kAdd>(k, A.data + static_cast<long>(i) * A.row, A,
                                  B, ldb, C + static_cast<long>(i) * ldc, ldc);
  };
  int i = 0;
  for (; i + kTileRows <= m; i += kTileRows)
    tile.template operator()<kTileRows>(i);
  for (; i + 4 <= m; i += 4) tile.template operator()<4>(i);
  for (; i < m; ++i) tile.template operator()<1>(i);
}

template <bool kAdd>
inline void Multiply(int m, int n, int k, StridedMatrix A, const double* B,
                     int ldb, double* C, int ldc) {
  int j = 0;
  for (; j + 2 * kLanes <= n; j += 2 * kLanes)
    Columns<2, kAdd>(m, k, A, B + j, ldb, C + j, ldc);
  for (; j + kLanes <= n; j += kLanes)
    Columns<1, kAdd>(m, k, A, B + j, ldb, C + j, ldc);
}

void MultiplyAdd(int m, int n, int k, StridedMatrix A, const double* B, int ldb,
                 double* C, int ldc) {
  Multiply<true>(m, n, k, A, B, ldb, C, ldc);
}

void MultiplySubtract(int m, int n, int k, StridedMatrix A, const double* B,
                      int ldb, double* C, int ldc) {
  Multiply<false>(m, n, k, A, B, ldb, C, ldc);
}

// kRows rows of the sum of products, which stay in registers over all of them.
template <int kRows, bool kAdd>
inline void BlockRows(int count, const double* const* A, size_t at,
                      const double* B, int ldb, double* C) {
  Register sum[kRows][kRow] = {};
  for (int j = 0; j < count; ++j) {
    const double* a = A[j] + at;
    for (int l = 0; l < kBlock; ++l, B += ldb) {
      Register right[kRow];
#pragma GCC unroll 4
      for (int v = 0; v < kRow; ++v)
        right[v] = *reinterpret_cast<const Register*>(B + v * kLanes);
#pragma GCC unroll 8
      for (int r = 0; r < kRows; ++r) {
        const double factor = a[r * kBlock + l];
#pragma GCC unroll 4
        for (int v = 0; v < kRow; ++v) sum[r][v] += factor * right[v];
      }
    }
  }
#pragma GCC unroll 8
  for (int r = 0; r < kRows; ++r)
#pragma GCC unroll 4
    for (int v = 0; v < kRow; ++v) {
      Register& out = *reinterpret_cast<Register*>(C + r * kBlock + v * kLanes);
      out = kAdd ? out + sum[r][v] : out - sum[r][v];
    }
}

// A CPU foresees what is read of no more than so many blocks at a time.
constexpr int kStreams = 8;

template <bool kAdd>
inline void Blocks(int m, int count, const double* const* A, size_t at,
                   const double* B, int ldb, double* C) {
  constexpr int kRows = kTogether * kTile;
  for (int j = 0; j < count; j += kStreams) {
    const int streams = count - j < kStreams ? count - j : kStreams;
    const double* b = B + static_cast<long>(j) * kBlock * ldb;
    const auto rows = [&]<int kCount>(int i) {
      BlockRows<kCount, kAdd>(streams, A + j, at + i * kBlock, b, ldb,
                              C + i * kBlock);
    };
    int i = 0;
    for (; i + kRows <= m; i += kRows) rows.template operator()<kRows>(i);
    for (; i < m; ++i) rows.template operator()<1>(i);
  }
}

void BlocksAdd(int m, int count, const double* const* A, size_t at,
               const double* B, int ldb, double* C) {
  Blocks<true>(m, count, A, at, B, ldb, C);
}

void BlocksSubtract(int m, int count, const double* const* A, size_t at,
                    const double* B, int ldb, double* C) {
  Blocks<false>(m, count, A, at, B, ldb, C);
}

inline Register* RowOf(double* X, const int* rows, int i) {
  return reinterpret_cast<Register*>(
      X + static_cast<long>(rows == nullptr ? i : rows[i]) * kBlock);
}
inline const Register* RowOf(const double* X, const int* rows, int i) {
  return RowOf(const_cast<double*>(X), rows, i);
}

void SparseSubtract(int n, const size_t* start, const int* columns,
                    const double* values, const double* X, double* Y) {
  for (int i = 0; i < n; ++i) {
    Register sum[kRow] = {};
    for (size_t e = start[i]; e < start[i + 1]; ++e)
      for (int v = 0; v < kRow; ++v)
        sum[v] += values[e] * RowOf(X, columns, static_cast<int>(e))[v];
    for (int v = 0; v < kRow; ++v) RowOf(Y, nullptr, i)[v] -= sum[v];
  }
}

// body.operator()<tiles>(rows, P, i) for all tiles of P, some at once: `rows`
// from row i on are there.
template <typename Body>
inline void ForTiles(int m, int k, const double* P, const Body& body) {
  constexpr int kRows = kTogether * kTile;
  int i = 0;
  for (; i + kRows <= m; i += kRows, P += static_cast<long>(kRows) * k)
    body.template operator()<kTogether>(kRows, P, i);
  for (; i < m; i += kTile, P += static_cast<long>(kTile) * k)
    body.template operator()<1>(m - i, P, i);
}

// sum = the product of kTiles tiles with k rows of X.
template <int kTiles>
inline void MultiplyTiles(int k, const double* P, const double* X,
                          Register (&sum)[kTiles * kTile][kRow]) {
  for (int l = 0; l < k; ++l) {
    Register right[kRow];
#pragma GCC unroll 4
    for (int v = 0; v < kRow; ++v) right[v] = RowOf(X, nullptr, l)[v];
#pragma GCC unroll 8
    for (int r = 0; r < kTiles * kTile; ++r) {
      const double factor =
          P[(static_cast<long>(r / kTile) * k + l) * kTile + r % kTile];
#pragma GCC unroll 4
      for (int v = 0; v < kRow; ++v) sum[r][v] += factor * right[v];
    }
  }
}

// `rows` of the tiles are there.
template <int kTiles>
inline void TileDown(int rows, int k, const double* P, const double* X,
                     double* C, const int* c_rows, int i) {
  Register sum[kTiles * kTile][kRow] = {};
  MultiplyTiles<kTiles>(k, P, X, sum);
#pragma GCC unroll 8
  for (int r = 0; r < kTiles * kTile; ++r) {
    if (r >= rows) return;
    Register* out = RowOf(C, c_rows, i + r);
#pragma GCC unroll 4
    for (int v = 0; v < kRow; ++v) out[v] -= sum[r][v];
  }
}

void TilesDown(int m, int k, const double* P, const double* X, double* C,
               const int* c_rows) {
  ForTiles(m, k, P, [&]<int kTiles>(int rows, const double* tiles, int i) {
    TileDown<kTiles>(rows, k, tiles, X, C, c_rows, i);
  });
}

// sum += or -= the transpose of kTiles tiles times their rows of X.
template <int kTiles, bool kAdd>
inline void AddTransposed(int k, const double* P,
                          const Register (&x)[kTiles * kTile][kRow],
                          double* sum) {
  for (int l = 0; l < k; ++l) {
    Register* out = RowOf(sum, nullptr, l);
    Register total[kRow];
#pragma GCC unroll 4
    for (int v = 0; v < kRow; ++v) total[v] = out[v];
#pragma GCC unroll 8
    for (int r = 0; r < kTiles * kTile; ++r) {
      const double factor =
          P[(static_cast<long>(r / kTile) * k + l) * kTile + r % kTile];
#pragma GCC unroll 4
      for (int v = 0; v < kRow; ++v)
        total[v] =
            kAdd ? total[v] + factor * x[r][v] : total[v] - factor * x[r][v];
    }
#pragma GCC unroll 4
    for (int v = 0; v < kRow; ++v) out[v] = total[v];
  }
}

// Rows that are not there are the first one, times zero.
template <int kTiles>
inline void TileUp(int rows, int k, const double* P, const double* X,
                   const int* x_rows, int i, double* sum) {
  Register x[kTiles * kTile][kRow];
#pragma GCC unroll 8
  for (int r = 0; r < kTiles * kTile; ++r) {
    const Register* row = RowOf(X, x_rows, r < rows ? i + r : i);
#pragma GCC unroll 4
    for (int v = 0; v < kRow; ++v) x[r][v] = row[v];
  }
  AddTransposed<kTiles, false>(k, P, x, sum);
}

void TilesUp(int m, int k, const double* P, const double* X, const int* x_rows,
             double* sum) {
  ForTiles(m, k, P, [&]<int kTiles>(int rows, const double* tiles, int i) {
    TileUp<kTiles>(rows, k, tiles, X, x_rows, i, sum);
  });
}

// The last rows first: those before them are still what they were.
void TriangleDown(int k, const double* T, double* X) {
  for (int i = (k - 1) / kTile * kTile; i >= 0; i -= kTile) {
    const int columns = TriangleTileColumns(k, i);
    Register sum[kTile][kRow] = {};
    MultiplyTiles<1>(columns, T, X, sum);
    T += kTile * columns;
    for (int r = 0; r < kTile && i + r < k; ++r)
      for (int v = 0; v < kRow; ++v) RowOf(X, nullptr, i + r)[v] = sum[r][v];
  }
}

void TriangleUp(int k, const double* T, const double* scale, double* sum,
                double* X) {
  for (int i = (k - 1) / kTile * kTile; i >= 0; i -= kTile) {
    const int columns = TriangleTileColumns(k, i);
    Register x[kTile][kRow] = {};
    for (int r = 0; r < kTile && i + r < k; ++r)
      for (int v = 0; v < kRow; ++v)
        x[r][v] = scale[i + r] * RowOf(X, nullptr, i + r)[v];
    AddTransposed<1, true>(columns, T, x, sum);
    T += kTile * columns;
  }
  for (int i = 0; i < k; ++i)
    for (int v = 0; v < kRow; ++v)
      RowOf(X, nullptr, i)[v] = RowOf(sum, nullptr, i)[v];
}

constexpr DenseKernels KernelsNamed(const char* name) {
  return {&MultiplyAdd,    &MultiplySubtract,
          &BlocksAdd,      &BlocksSubtract,
          &SparseSubtract, &TilesDown,
          &TilesUp,        &TriangleDown,
          &TriangleUp,     name};
}

}  // namespace
}  // namespace marrow
// NOLINTEND(bugprone-implicit-widening-of-multiplication-result,google-build-namespaces)

#endif  // MARROW_CORE_SPECTRUM_DENSE_KERNELS_BODY_H_
