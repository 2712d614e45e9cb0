// The inner loops of the eigensolver, compiled once for each kind of CPU.
#ifndef MARROW_CORE_SPECTRUM_DENSE_KERNELS_H_
#define MARROW_CORE_SPECTRUM_DENSE_KERNELS_H_

#include <cstddef>

namespace marrow {

// Right-hand sides and Lanczos vectors come in blocks of this many, row-major.
// More would share the reading of a factor; fewer make a smaller basis do.
inline constexpr int kBlock = 8;
// Rows of dense panels are padded to multiples of this.
inline constexpr int kPad = 8;

inline constexpr int PadUp(int n) { return (n + kPad - 1) / kPad * kPad; }

// A tile is so many rows of a matrix, by columns; a matrix in tiles, one tile
// after the other, is read from its first double to its last. Where there are
// too few rows for the last, they are zeros.
inline constexpr int kTile = 4;

inline constexpr size_t TilesSize(int m, int k) {
  return static_cast<size_t>((m + kTile - 1) / kTile * kTile) * k;
}

// Of a lower triangle in tiles, the last of them first; a tile's columns that
// are zero are left out.
inline constexpr int TriangleTileColumns(int k, int first_row) {
  return first_row + kTile < k ? first_row + kTile : k;
}
inline constexpr size_t TriangleSize(int k) {
  size_t size = 0;
  for (int i = 0; i < k; i += kTile)
    size += size_t{kTile} * TriangleTileColumns(k, i);
  return size;
}

// A(i, l) = data[i * row + l * column].
struct StridedMatrix {
  const double* data;
  int row;
  int column;
};

// All matrices are of doubles; B and C are row-major, `ldb` and `ldc` doubles a
// row. The order of additions within an entry of C is that of l, so a result
// does not depend on how m or n are divided between calls.
struct DenseKernels {
  // C (m x n) += or -= A (m x k) B (k x n). REQUIRES: n is a multiple of kPad.
  void (*multiply_add)(int m, int n, int k, StridedMatrix A, const double* B,
                       int ldb, double* C, int ldc);
  void (*multiply_subtract)(int m, int n, int k, StridedMatrix A,
                            const double* B, int ldb, double* C, int ldc);
  // C += or -= the sum over j of A_j B_j, where A_j = A[j] + at and C have m
  // rows of kBlock, and B, of all B_j one below the other, `ldb` doubles a row.
  void (*blocks_add)(int m, int count, const double* const* A, size_t at,
                     const double* B, int ldb, double* C);
  void (*blocks_subtract)(int m, int count, const double* const* A, size_t at,
                          const double* B, int ldb, double* C);
  // Y -= A X for rows of kBlock, with A (n x n) sparse: entries start[i] up to
  // start[i + 1] are those of its row i.
  void (*sparse_subtract)(int n, const size_t* start, const int* columns,
                          const double* values, const double* X, double* Y);
  // With P (m x k) in tiles and blocks of rows of kBlock: C -= P X, where row i
  // of C is row c_rows[i] of an array, or row i where `c_rows` is null; and
  // sum -= P'X, the same with the rows of X.
  void (*tiles_down)(int m, int k, const double* P, const double* X, double* C,
                     const int* c_rows);
  void (*tiles_up)(int m, int k, const double* P, const double* X,
                   const int* x_rows, double* sum);
  // With T (k x k), lower triangular, in tiles: X = T X, and
  // X = T'D X + sum, with D = diag(scale). `sum` is of no use afterwards.
  void (*triangle_down)(int k, const double* T, double* X);
  void (*triangle_up)(int k, const double* T, const double* scale, double* sum,
                      double* X);
  const char* name;
};

// The best for this CPU; "avx512", "avx2" or "plain".
const DenseKernels& Kernels();

// Those that this CPU can run, the plain ones first, ended by null.
const DenseKernels* const* AllKernels();

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_DENSE_KERNELS_H_
