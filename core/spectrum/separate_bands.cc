#include "core/spectrum/separate_bands.h"

#include <algorithm>

namespace marrow {
namespace {

// Columns first to end.
struct Range {
  Eigen::Index first, end;
  Eigen::Index size() const { return end - first; }
};

std::vector<Eigen::Index> LooseOf(const Range& range,
                                  const std::vector<double>& residuals,
                                  double loose) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = range.first; k < range.end; ++k)
    if (residuals[k] > loose) columns.push_back(k);
  return columns;
}

// A column for each of `chosen`, a row for each of `range`: their products
// under M, in double.
Eigen::MatrixXd Overlaps(const Eigen::VectorXd& mass,
                         const EigenvectorMatrix& vectors,
                         const std::vector<Eigen::Index>& chosen,
                         const Range& range, const CancelToken& cancel) {
  const auto count = static_cast<Eigen::Index>(chosen.size());
  Eigen::MatrixXd overlaps = Eigen::MatrixXd::Zero(range.size(), count);
  Eigen::VectorXd row(range.size());
  if (count == 0) return overlaps;
  for (Eigen::Index v = 0; v < vectors.rows() && !cancel.IsCancelled(); ++v) {
    row = vectors.row(v).segment(range.first, range.size()).cast<double>();
    for (Eigen::Index c = 0; c < count; ++c)
      overlaps.col(c) += mass[v] * vectors(v, chosen[c]) * row;
  }
  return overlaps;
}

}  // namespace

void SeparateBands(const Eigen::VectorXd& mass,
                   const std::vector<double>& residuals, double loose,
                   Eigen::Index begin, const CancelToken& cancel,
                   EigenvectorMatrix& vectors) {
  const Range before{std::max<Eigen::Index>(0, begin - kBandReach), begin};
  const Range after{begin, static_cast<Eigen::Index>(residuals.size())};
  if (before.size() == 0 || after.size() == 0) return;
  const std::vector<Eigen::Index> loose_before =
      LooseOf(before, residuals, loose);
  const std::vector<Eigen::Index> loose_after =
      LooseOf(after, residuals, loose);
  if (loose_before.empty() && loose_after.empty()) return;
  Eigen::MatrixXd of_before =
      Overlaps(mass, vectors, loose_before, after, cancel);
  const Eigen::MatrixXd of_after =
      Overlaps(mass, vectors, loose_after, before, cancel);
  // Two columns that are both loose are parted once.
  for (Eigen::Index k : loose_after) of_before.row(k - begin).setZero();
  Eigen::VectorXd earlier(before.size()), taken(after.size());
  for (Eigen::Index v = 0; v < vectors.rows() && !cancel.IsCancelled(); ++v) {
    earlier =
        vectors.row(v).segment(before.first, before.size()).cast<double>();
    taken.setZero();
    for (size_t c = 0; c < loose_before.size(); ++c)
      taken += earlier[loose_before[c] - before.first] * of_before.col(c);
    for (size_t c = 0; c < loose_after.size(); ++c)
      taken[loose_after[c] - begin] += of_after.col(c).dot(earlier);
    vectors.row(v).segment(begin, after.size()) -=
        taken.transpose().cast<float>();
  }
}

}  // namespace marrow
