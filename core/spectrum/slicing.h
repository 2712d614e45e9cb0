// The lowest eigen-pairs of a sparse symmetric matrix by spectrum slicing.
#ifndef MARROW_CORE_SPECTRUM_SLICING_H_
#define MARROW_CORE_SPECTRUM_SLICING_H_

#include <Eigen/SparseCore>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/band_lanczos.h"

namespace marrow {

struct SlicingOptions {
  int threads = 2;
  // What the residual of a pair may be, in units of max(lambda, lambda_1).
  double tolerance = 1e-4;
  // Whether bands have their vectors in double.
  bool exact = false;
  // What one factor may take; there is one a thread, or one in all where two
  // would be too much.
  size_t max_factor_bytes = size_t{1} << 30;
};

// Which of the lowest pairs are wanted: all up to `bound` and one beyond it,
// but no less than `least` and no more than `pairs`. Who names a bound has no
// use for a part of a cluster: the pairs then end before more equal eigenvalues
// than can be asked for.
struct PairsWanted {
  int pairs = 0;
  double bound = std::numeric_limits<double>::infinity();
  int least = 0;
};

// So many eigenvalues are below a shift, by inertia.
struct InertiaCount {
  double shift = 0;
  int below = 0;
};

// Consecutive pairs: those from `first` up to `end` of a band.
struct SpectrumPart {
  Band band;
  int first = 0;
  int end = 0;
  // Whether it is of more equal eigenvalues than a usual band has pairs: its
  // end and its vectors may depend on how many pairs may be asked for.
  bool of_cluster = false;
  // Made inside the band and, beyond the last pair that was found, after it.
  std::vector<InertiaCount> counts;
};

// Called with a share of the work, never falling, on the calling thread.
using ShareCallback = std::function<void(double)>;

// Finds pairs in ascending order, certified, and goes on from there. Not thread
// safe; holds some 1 kB an unknown between calls.
class SpectrumSlicer {
 public:
  // `matrix` is symmetric and positive semi-definite with a full pattern and
  // diagonal, and not tiny (some hundred rows); `positions` has a row of three
  // an unknown. Neither is kept. No more than `most_pairs` will be asked for,
  // at most half the rows. Errors: CANCELLED; RESOURCE_EXHAUSTED where a factor
  // does not fit.
  static absl::StatusOr<std::unique_ptr<SpectrumSlicer>> Create(
      const Eigen::SparseMatrix<double>& matrix, const double* positions,
      int most_pairs, const SlicingOptions& options, const CancelToken& cancel);
  virtual ~SpectrumSlicer() = default;

  // The parts that follow those found before, until what is wanted is there or
  // the next cannot be found: then the next call has the error, unless it is
  // one of the first two below. None if what is wanted was there, or where a
  // cluster ends the pairs as PairsWanted says. That no pair
  // is missing or twice is certified by the inertia at every shift and beyond
  // the last pair. The same bytes at any number of threads and in whatever
  // steps they are asked for. Errors: CANCELLED; RESOURCE_EXHAUSTED; INTERNAL
  // where a certificate fails for good. After an error this is not to be used
  // any more. REQUIRES: wanted.pairs <= most_pairs.
  virtual absl::StatusOr<std::vector<SpectrumPart>> Find(
      const PairsWanted& wanted, const CancelToken& cancel,
      const ShareCallback& progress) = 0;

  // The eigenvalues below a shift, or a little above it where it is one. Not to
  // be called during Find(). Errors: CANCELLED; RESOURCE_EXHAUSTED; INTERNAL
  // where the matrix cannot be factorised.
  virtual absl::StatusOr<InertiaCount> Count(double shift,
                                             const CancelToken& cancel) = 0;

  // Row of a band's vectors -> unknown of the matrix.
  virtual const std::vector<int>& order() const = 0;
};

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SLICING_H_
