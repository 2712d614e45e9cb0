#include "core/spectrum/certificate.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/spectrum/dense_kernels.h"
#include "core/spectrum/lanczos_basis.h"

namespace marrow {
namespace {

using Row = Eigen::Array<double, 1, kBlock>;

}  // namespace

void FixSign(Eigen::Ref<Eigen::VectorXd> vector) {
  Eigen::Index at = 0;
  vector.cwiseAbs().maxCoeff(&at);
  if (vector[at] < 0) vector = -vector;
}

double MeasureResiduals(const Laplacian& laplacian, int first, int end,
                        CertifiedSpectrum& spectrum) {
  const auto& [L, M, report] = laplacian;
  double worst = 0;
  RowMajorMatrix phi(L.rows(), kBlock);
  for (int begin = first; begin < end; begin += kBlock) {
    const int width = std::min(kBlock, end - begin);
    phi.leftCols(width) = spectrum.eigenvectors.middleCols(begin, width);
    phi.rightCols(kBlock - width).setZero();
    Row lambda = Row::Zero();
    lambda.head(width) = spectrum.eigenvalues.segment(begin, width);
    Row squares = Row::Zero();
    for (int v = 0; v < L.outerSize(); ++v) {
      Row rest = -M[v] * lambda * phi.row(v).array();
      // L is symmetric, so its columns are its rows.
      for (Eigen::SparseMatrix<double>::InnerIterator entry(L, v); entry;
           ++entry)
        rest += entry.value() * phi.row(entry.index()).array();
      squares += rest.square() / M[v];
    }
    const Row residuals =
        squares.sqrt() / lambda.cwiseMax(spectrum.eigenvalues[1]);
    spectrum.residuals.segment(begin, width) = residuals.head(width);
    worst = std::max(worst, residuals.head(width).maxCoeff());
  }
  return worst;
}

absl::Status Disagreement(double shift, int counted, int found) {
  return WithReason(absl::InternalError(absl::StrCat(
                        "the mesh has ", counted, " eigenvalues below ", shift,
                        ", but ", found, " were found")),
                    kReasonSolverNotConverged);
}

absl::Status OutOfMemory(int count, int vertices) {
  return absl::ResourceExhaustedError(
      absl::StrCat("not enough memory for ", count,
                   " eigen-pairs in double of ", vertices, " vertices"));
}

// Where the last pair has equals among those that are not known, the count is
// made below it, at the last gap that a count can tell.
absl::Status CountPairs(
    const Eigen::VectorXd& known,
    const std::function<absl::StatusOr<InertiaCount>(double)>& count_below,
    CertifiedSpectrum& spectrum) {
  const int all = static_cast<int>(known.size());
  const int count = static_cast<int>(spectrum.NumPairs());
  const double margin = kCountableGap * spectrum.eigenvalues[count - 1];
  InertiaCount counted;
  int pair = count;
  if (pair == all) {
    MARROW_ASSIGN_OR_RETURN(
        counted, count_below(spectrum.eigenvalues[count - 1] + margin));
    if (counted.below < count)
      return Disagreement(counted.shift, counted.below, count);
    if (counted.below > count) --pair;
  }
  if (pair < all) {
    const auto gap = [&](int above) { return known[above] - known[above - 1]; };
    while (pair > 1 && gap(pair) <= 4 * margin) --pair;
    const double middle = 0.5 * (known[pair] + known[pair - 1]);
    MARROW_ASSIGN_OR_RETURN(counted, count_below(middle));
    if (counted.below != pair && gap(pair) > kCountableGap * counted.shift)
      return Disagreement(counted.shift, counted.below, pair);
  }
  spectrum.bound = counted.shift;
  spectrum.count_below_bound = static_cast<uint32_t>(counted.below);
  return absl::OkStatus();
}

}  // namespace marrow
