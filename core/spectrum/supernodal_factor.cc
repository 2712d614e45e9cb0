// Multifrontal elimination: a supernode gathers the updates of its children and
// its entries, eliminates its columns densely and passes one update on. All of
// it works on the transpose, upper and row-major: what is below a pivot's
// column is to the right of its row, contiguous.
//
// Why no pivoting: it would change the structure with the shift. The matrices
// are positive definite but for as many directions as eigenvalues are below the
// shift; those show up in the last, largest fronts. What growth there is, the
// residuals of the pairs would tell.
#include "core/spectrum/supernodal_factor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "absl/strings/str_cat.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

// Rows eliminated before what is below is updated, and before what is left of
// these rows is.
constexpr int kBlockRows = 64;
constexpr int kStepRows = 8;
// Rows of the trailing triangle updated at a time.
constexpr int kTileRows = 32;
constexpr double kLeastPivot = 1e-14;

int PadDown(int n) { return n / kPad * kPad; }

size_t LargestPanelStride(const SupernodalStructure& structure) {
  int most = 0;
  for (const auto& node : structure.supernodes)
    most = std::max(most, node.PanelStride());
  return most;
}

}  // namespace

SupernodalFactor::SupernodalFactor(const SupernodalStructure& structure)
    : structure_(structure),
      kernels_(Kernels()),
      panels_(structure.panel_doubles),
      stack_(structure.stack_doubles),
      front_(structure.largest_front_rows *
             PadUp(static_cast<int>(structure.largest_front_rows))),
      scaled_(kBlockRows * LargestPanelStride(structure)),
      inverse_pivots_(structure.n) {}

absl::Status SupernodalFactor::Compute(double shift,
                                       const CancelToken& cancel) {
  shift_ = shift;
  negative_pivots_ = 0;
  waiting_.clear();
  stack_top_ = 0;
  const int count = static_cast<int>(structure_.supernodes.size());
  for (int k = 0; k < count; ++k) {
    const Supernode& node = structure_.supernodes[k];
    Assemble(k);
    MARROW_RETURN_IF_ERROR(Eliminate(node, panels_.data() + node.panel,
                                     front_.data(), cancel));
    if (node.num_rows == 0) continue;
    PushUpdate(node, front_.data());
    waiting_.push_back(k);
  }
  return absl::OkStatus();
}

void SupernodalFactor::Assemble(int index) {
  const Supernode& node = structure_.supernodes[index];
  double* panel = panels_.data() + node.panel;
  std::memset(panel, 0, node.PanelSize() * sizeof(double));
  std::memset(front_.data(), 0,
              sizeof(double) * node.num_rows * PadUp(node.num_rows));
  for (size_t e = structure_.row_start[node.first];
       e < structure_.row_start[node.first + node.width]; ++e)
    panel[structure_.offsets[e]] = structure_.values[e];
  for (int i = 0; i < node.width; ++i)
    panel[static_cast<size_t>(i) * node.PanelStride() + i] -= shift_;
  while (!waiting_.empty() &&
         structure_.supernodes[waiting_.back()].parent == index) {
    const Supernode& child = structure_.supernodes[waiting_.back()];
    stack_top_ -= static_cast<size_t>(child.num_rows) * PadUp(child.num_rows);
    AddUpdate(child, stack_.data() + stack_top_, node, panel, front_.data());
    waiting_.pop_back();
  }
}

void SupernodalFactor::AddUpdate(const Supernode& child, const double* update,
                                 const Supernode& parent, double* panel,
                                 double* front) const {
  const int* to = structure_.relative.data() + child.rows;
  const int own = parent.OwnWidth(), count = child.num_rows;
  const size_t stride = parent.PanelStride();
  const size_t front_stride = PadUp(parent.num_rows);
  const size_t update_stride = PadUp(count);
  for (int i = 0; i < count; ++i) {
    const double* row = update + i * update_stride;
    double* out = to[i] < own ? panel + to[i] * stride
                              : front + (to[i] - own) * front_stride - own;
    for (int j = i; j < count; ++j) out[to[j]] += row[j];
  }
}

absl::Status SupernodalFactor::Eliminate(const Supernode& node, double* panel,
                                         double* front,
                                         const CancelToken& cancel) {
  const size_t stride = node.PanelStride();
  for (int begin = 0; begin < node.width; begin += kBlockRows) {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    const int end = std::min(begin + kBlockRows, node.width);
    double* scaled = scaled_.data();
    for (int step = begin; step < end; step += kStepRows) {
      const int step_end = std::min(step + kStepRows, end);
      MARROW_RETURN_IF_ERROR(EliminateStep(node, panel, step, step_end, end,
                                           scaled + (step - begin) * stride));
    }
    UpdateBelow(node, panel, front, begin, end, scaled);
    std::memcpy(panel + begin * stride, scaled,
                (end - begin) * stride * sizeof(double));
  }
  return absl::OkStatus();
}

// Rows `begin` up to `end`; then these are subtracted from the other rows of
// their block. `scaled` receives the rows over their pivots.
absl::Status SupernodalFactor::EliminateStep(const Supernode& node,
                                             double* panel, int begin, int end,
                                             int block_end, double* scaled) {
  const int stride = node.PanelStride();
  for (int k = begin; k < end; ++k) {
    double* row = panel + static_cast<size_t>(k) * stride;
    const double pivot = row[k];
    const double scale =
        structure_.values[structure_.row_start[node.first + k]];
    if (!(std::abs(pivot) > kLeastPivot * std::abs(scale)))
      return absl::FailedPreconditionError(
          absl::StrCat("no pivot at the shift ", shift_));
    negative_pivots_ += pivot < 0;
    const double inverse = 1 / pivot;
    inverse_pivots_[node.first + k] = inverse;
    double* out = scaled + static_cast<size_t>(k - begin) * stride;
    const int from = PadDown(k);
    for (int j = from; j < stride; ++j) out[j] = row[j] * inverse;
    kernels_.multiply_subtract(end - k - 1, stride - from, 1,
                               {out + k + 1, 1, 0}, row + from, stride,
                               row + stride + from, stride);
  }
  if (end == block_end) return absl::OkStatus();
  const int from = PadDown(end);
  kernels_.multiply_subtract(
      block_end - end, stride - from, end - begin, {scaled + end, 1, stride},
      panel + static_cast<size_t>(begin) * stride + from, stride,
      panel + static_cast<size_t>(end) * stride + from, stride);
  return absl::OkStatus();
}

void SupernodalFactor::UpdateBelow(const Supernode& node, double* panel,
                                   double* front, int begin, int end,
                                   const double* scaled) const {
  const int stride = node.PanelStride(), own = node.OwnWidth();
  const double* rows = panel + static_cast<size_t>(begin) * stride;
  for (int i = end; i < node.width; i += kTileRows) {
    const int from = PadDown(i);
    kernels_.multiply_subtract(
        std::min(kTileRows, node.width - i), stride - from, end - begin,
        {scaled + i, 1, stride}, rows + from, stride,
        panel + static_cast<size_t>(i) * stride + from, stride);
  }
  const int front_stride = PadUp(node.num_rows);
  for (int i = 0; i < node.num_rows; i += kTileRows)
    kernels_.multiply_subtract(
        std::min(kTileRows, node.num_rows - i), front_stride - i, end - begin,
        {scaled + own + i, 1, stride}, rows + own + i, stride,
        front + static_cast<size_t>(i) * front_stride + i, front_stride);
}

void SupernodalFactor::PushUpdate(const Supernode& node, const double* front) {
  const size_t stride = PadUp(node.num_rows);
  double* out = stack_.data() + stack_top_;
  for (int i = 0; i < node.num_rows; ++i)
    std::memcpy(out + i * stride + i, front + i * stride + i,
                (node.num_rows - i) * sizeof(double));
  stack_top_ += node.num_rows * stride;
}

void SupernodalFactor::SolveDown(const Supernode& node, double* X) const {
  const double* panel = panels_.data() + node.panel;
  double* own = X + static_cast<size_t>(node.first) * kBlock;
  const int stride = node.PanelStride();
  kernels_.lower_solve(node.width, panel, stride, own);
  kernels_.scatter_subtract(node.num_rows, node.width,
                            {panel + node.OwnWidth(), 1, stride}, own, X,
                            structure_.rows.data() + node.rows);
}

void SupernodalFactor::SolveUp(const Supernode& node, double* X) const {
  const double* panel = panels_.data() + node.panel;
  double* own = X + static_cast<size_t>(node.first) * kBlock;
  const int stride = node.PanelStride();
  for (int i = 0; i < node.width; ++i)
    for (int c = 0; c < kBlock; ++c)
      own[i * kBlock + c] *= inverse_pivots_[node.first + i];
  kernels_.gather_subtract(node.width, node.num_rows,
                           {panel + node.OwnWidth(), stride, 1}, X,
                           structure_.rows.data() + node.rows, own);
  kernels_.upper_solve(node.width, panel, stride, own);
}

void SupernodalFactor::Solve(std::span<double* const> blocks) const {
  for (const Supernode& node : structure_.supernodes)
    for (double* X : blocks) SolveDown(node, X);
  for (size_t k = structure_.supernodes.size(); k-- > 0;)
    for (double* X : blocks) SolveUp(structure_.supernodes[k], X);
}

}  // namespace marrow
