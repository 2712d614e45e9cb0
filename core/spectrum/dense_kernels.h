// The inner loops of the eigensolver, compiled once for each kind of CPU.
#ifndef MARROW_CORE_SPECTRUM_DENSE_KERNELS_H_
#define MARROW_CORE_SPECTRUM_DENSE_KERNELS_H_

namespace marrow {

// Right-hand sides and Lanczos vectors come in blocks of this many, row-major.
// More would share the reading of a factor; fewer make a smaller basis do.
inline constexpr int kBlock = 8;
// Rows of dense panels are padded to multiples of this.
inline constexpr int kPad = 8;

inline constexpr int PadUp(int n) { return (n + kPad - 1) / kPad * kPad; }

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
  // As multiply_subtract with n = kBlock; row i of C is row c_rows[i] of an
  // array of rows of kBlock.
  void (*scatter_subtract)(int m, int k, StridedMatrix A, const double* B,
                           double* C, const int* c_rows);
  // The same with the rows of B.
  void (*gather_subtract)(int m, int k, StridedMatrix A, const double* B,
                          const int* b_rows, double* C);
  // X (width x kBlock) = T^-1 X and T'^-1 X. T is unit lower triangular and
  // T(i, l) = panel[l * stride + i].
  void (*lower_solve)(int width, const double* panel, int stride, double* X);
  void (*upper_solve)(int width, const double* panel, int stride, double* X);
  const char* name;
};

// The best for this CPU; "avx512", "avx2" or "plain".
const DenseKernels& Kernels();

// Those that this CPU can run, the plain ones first, ended by null.
const DenseKernels* const* AllKernels();

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_DENSE_KERNELS_H_
