#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/operators/laplacian.h"

namespace marrow {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double kMaxPositive = 1e-14;
constexpr double kMaxRowSum = 1e-12;

absl::Status Broken(const std::string& what, Eigen::Index row) {
  return absl::InternalError(
      absl::StrCat("the Laplacian has ", what, " in row ", row));
}

// Columns are read from left to right, so column i meets its entries (j, i) in
// the order in which the columns j present their entries (i, j).
absl::Status CheckSymmetry(const Sparse& L) {
  const int* starts = L.outerIndexPtr();
  std::vector<int> next(starts, starts + L.cols());
  for (Eigen::Index j = 0; j < L.cols(); ++j) {
    for (Sparse::InnerIterator it(L, j); it; ++it) {
      const Eigen::Index i = it.row();
      const int at = next[i]++;
      if (at >= starts[i + 1] || L.innerIndexPtr()[at] != j ||
          L.valuePtr()[at] != it.value())
        return Broken("an entry without an equal twin", i);
    }
  }
  return absl::OkStatus();
}

// By symmetry a column is a row.
absl::Status CheckRows(const Sparse& L, double scale) {
  for (Eigen::Index j = 0; j < L.cols(); ++j) {
    long double sum = 0;
    for (Sparse::InnerIterator it(L, j); it; ++it) {
      if (!std::isfinite(it.value()))
        return Broken("an entry that is not finite", j);
      if (it.row() != j && it.value() > kMaxPositive * scale)
        return Broken("a negative weight", j);
      sum += it.value();
    }
    if (std::abs(sum) > kMaxRowSum * scale) return Broken("a sum", j);
  }
  return absl::OkStatus();
}

absl::Status CheckMasses(const Eigen::VectorXd& M) {
  for (Eigen::Index v = 0; v < M.size(); ++v)
    if (!(M[v] > 0) || !std::isfinite(M[v])) return Broken("no mass", v);
  const long double sum = std::accumulate(M.begin(), M.end(), 0.0L);
  if (!(std::abs(sum - 1) <= kMaxRowSum))
    return absl::InternalError("the masses do not sum to 1");
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckLaplacian(const Laplacian& laplacian) {
  const Sparse& L = laplacian.L;
  if (L.rows() != laplacian.M.size() || L.cols() != laplacian.M.size() ||
      !L.isCompressed())
    return absl::InternalError("the Laplacian has the wrong shape");
  double scale = 0;
  for (Eigen::Index i = 0; i < L.cols(); ++i)
    scale = std::max(scale, L.coeff(i, i));
  absl::Status status = CheckMasses(laplacian.M);
  status.Update(CheckRows(L, scale));
  status.Update(CheckSymmetry(L));
  return status;
}

}  // namespace marrow
