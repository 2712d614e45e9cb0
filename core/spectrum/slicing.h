// The lowest eigen-pairs of a sparse symmetric matrix by spectrum slicing.
#ifndef MARROW_CORE_SPECTRUM_SLICING_H_
#define MARROW_CORE_SPECTRUM_SLICING_H_

#include <Eigen/SparseCore>
#include <cstddef>
#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/band_lanczos.h"

namespace marrow {

struct SlicingOptions {
  int threads = 2;
  // In units of max(lambda, lambda_1).
  double tolerance = 1e-6;
  // Pairs of a usual band.
  int band = 40;
  // What one factor may take; there is one a thread.
  size_t max_factor_bytes = size_t{1} << 30;
};

// The bands in ascending order, and from each the pairs `first` up to `end`.
struct SlicedSpectrum {
  struct Part {
    Band band;
    int first;
    int end;
  };
  std::vector<Part> parts;
  std::vector<int> order;  // row of a band's vectors -> unknown of the matrix
  // Whether the last pair may have equals that are not here.
  bool ends_in_cluster = false;
  double residual = 0;  // the largest
};

// Called with a share of the work, never falling, on the calling thread.
using ShareCallback = std::function<void(double)>;

// The `pairs` lowest pairs of `matrix`, which is symmetric and positive
// semi-definite with a full pattern and diagonal; `positions` has a row of
// three an unknown. That none is missing or twice is certified by the inertia
// at every shift and beyond the last pair. The same bytes at any number of
// threads. Errors: CANCELLED; RESOURCE_EXHAUSTED where a factor or the vectors
// do not fit; INTERNAL where a certificate fails for good. REQUIRES: pairs <
// matrix.rows(), and that is not tiny (some hundred).
absl::StatusOr<SlicedSpectrum> SliceSpectrum(
    const Eigen::SparseMatrix<double>& matrix, const double* positions,
    int pairs, const SlicingOptions& options, const CancelToken& cancel,
    const ShareCallback& progress);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SLICING_H_
