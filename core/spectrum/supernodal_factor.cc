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
#include <vector>

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

// Work of a tile, in multiplications, from which a team is worth asking.
constexpr double kTeamWork = 1e6;

size_t UpdateSize(const SupernodalStructure::Supernode& node) {
  return static_cast<size_t>(node.num_rows) * PadUp(node.num_rows);
}

}  // namespace

SupernodalFactor::SupernodalFactor(const SupernodalStructure& structure)
    : structure_(structure),
      kernels_(Kernels()),
      panels_(structure.panel_doubles),
      inverse_pivots_(structure.n),
      branches_(structure.branches.size()) {}

absl::Status SupernodalFactor::Compute(double shift, Team& team,
                                       const CancelToken& cancel) {
  shift_ = shift;
  Team alone(1);
  team.For(static_cast<int>(branches_.size()), [&](int b) {
    const SupernodalStructure::Branch& branch = structure_.branches[b];
    Workspace& work = branches_[b];
    work.status = EliminateRun(branch.begin, branch.end, work, alone, cancel);
  });
  negative_pivots_ = 0;
  for (Workspace& work : branches_) {
    MARROW_RETURN_IF_ERROR(work.status);
    negative_pivots_ += work.negative_pivots;
  }
  const int count = static_cast<int>(structure_.supernodes.size());
  MARROW_RETURN_IF_ERROR(
      EliminateRun(structure_.first_top, count, top_, team, cancel));
  negative_pivots_ += top_.negative_pivots;
  return absl::OkStatus();
}

absl::Status SupernodalFactor::EliminateRun(int begin, int end, Workspace& work,
                                            Team& team,
                                            const CancelToken& cancel) {
  work.negative_pivots = 0;
  work.waiting.clear();
  work.stack.clear();
  for (int k = begin; k < end; ++k) {
    Assemble(k, work);
    MARROW_RETURN_IF_ERROR(
        Eliminate(structure_.supernodes[k], work, team, cancel));
    if (structure_.supernodes[k].num_rows > 0) PushUpdate(k, work);
  }
  return absl::OkStatus();
}

void SupernodalFactor::Assemble(int index, Workspace& work) {
  const Supernode& node = structure_.supernodes[index];
  double* panel = panels_.data() + node.panel;
  std::memset(panel, 0, node.PanelSize() * sizeof(double));
  work.front.assign(UpdateSize(node), 0.0);
  for (size_t e = structure_.row_start[node.first];
       e < structure_.row_start[node.first + node.width]; ++e)
    panel[structure_.offsets[e]] = structure_.values[e];
  for (int i = 0; i < node.width; ++i)
    panel[static_cast<size_t>(i) * node.PanelStride() + i] -= shift_;
  if (index >= structure_.first_top)
    for (Workspace& branch : branches_) {
      if (branch.waiting.empty()) continue;
      const Supernode& root = structure_.supernodes[branch.waiting.back()];
      if (root.parent == index)
        AddUpdate(root, branch.stack.data(), node, work.front.data());
    }
  while (!work.waiting.empty() &&
         structure_.supernodes[work.waiting.back()].parent == index) {
    const Supernode& child = structure_.supernodes[work.waiting.back()];
    const size_t rest = work.stack.size() - UpdateSize(child);
    AddUpdate(child, work.stack.data() + rest, node, work.front.data());
    work.stack.resize(rest);
    work.waiting.pop_back();
  }
}

void SupernodalFactor::AddUpdate(const Supernode& child, const double* update,
                                 const Supernode& parent, double* front) {
  const int* to = structure_.relative.data() + child.rows;
  double* panel = panels_.data() + parent.panel;
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

absl::Status SupernodalFactor::Eliminate(const Supernode& node, Workspace& work,
                                         Team& team,
                                         const CancelToken& cancel) {
  const size_t stride = node.PanelStride();
  double* panel = panels_.data() + node.panel;
  work.scaled.resize(
      std::max(work.scaled.size(), std::min(kBlockRows, node.width) * stride));
  for (int begin = 0; begin < node.width; begin += kBlockRows) {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    const int end = std::min(begin + kBlockRows, node.width);
    for (int step = begin; step < end; step += kStepRows)
      MARROW_RETURN_IF_ERROR(EliminateStep(
          node, step, std::min(step + kStepRows, end), end,
          work.scaled.data() + (step - begin) * stride, work.negative_pivots));
    UpdateBelow(node, begin, end, work, team);
    std::memcpy(panel + begin * stride, work.scaled.data(),
                (end - begin) * stride * sizeof(double));
  }
  return absl::OkStatus();
}

// Rows `begin` up to `end`; then these are subtracted from the other rows of
// their block. `scaled` receives the rows over their pivots.
absl::Status SupernodalFactor::EliminateStep(const Supernode& node, int begin,
                                             int end, int block_end,
                                             double* scaled,
                                             int& negative_pivots) {
  const int stride = node.PanelStride();
  double* panel = panels_.data() + node.panel;
  for (int k = begin; k < end; ++k) {
    double* row = panel + static_cast<size_t>(k) * stride;
    const double pivot = row[k];
    const double scale =
        structure_.values[structure_.row_start[node.first + k]];
    if (!(std::abs(pivot) > kLeastPivot * std::abs(scale)))
      return absl::FailedPreconditionError(
          absl::StrCat("no pivot at the shift ", shift_));
    negative_pivots += pivot < 0;
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

void SupernodalFactor::UpdateBelow(const Supernode& node, int begin, int end,
                                   Workspace& work, Team& team) {
  const int stride = node.PanelStride(), own = node.OwnWidth();
  const int front_stride = PadUp(node.num_rows);
  double* panel = panels_.data() + node.panel;
  const double* rows = panel + static_cast<size_t>(begin) * stride;
  const double* scaled = work.scaled.data();
  const int own_tiles = (node.width - end + kTileRows - 1) / kTileRows;
  const int tiles = own_tiles + (node.num_rows + kTileRows - 1) / kTileRows;
  const auto update = [&](int tile) {
    if (tile < own_tiles) {
      const int i = end + tile * kTileRows, from = PadDown(i);
      kernels_.multiply_subtract(
          std::min(kTileRows, node.width - i), stride - from, end - begin,
          {scaled + i, 1, stride}, rows + from, stride,
          panel + static_cast<size_t>(i) * stride + from, stride);
    } else {
      const int i = (tile - own_tiles) * kTileRows;
      kernels_.multiply_subtract(
          std::min(kTileRows, node.num_rows - i), front_stride - i, end - begin,
          {scaled + own + i, 1, stride}, rows + own + i, stride,
          work.front.data() + static_cast<size_t>(i) * front_stride + i,
          front_stride);
    }
  };
  if (static_cast<double>(end - begin) * stride * kTileRows * tiles >
      kTeamWork) {
    team.For(tiles, update);
  } else {
    for (int tile = 0; tile < tiles; ++tile) update(tile);
  }
}

void SupernodalFactor::PushUpdate(int index, Workspace& work) const {
  const Supernode& node = structure_.supernodes[index];
  work.stack.insert(work.stack.end(), work.front.begin(),
                    work.front.begin() + UpdateSize(node));
  work.waiting.push_back(index);
}

void SupernodalFactor::SolveDown(const Supernode& node, double* X,
                                 double* top) const {
  const double* panel = panels_.data() + node.panel;
  double* own = X + static_cast<size_t>(node.first) * kBlock;
  const int stride = node.PanelStride();
  kernels_.lower_solve(node.width, panel, stride, own);
  const int* rows = structure_.rows.data() + node.rows;
  const int below = node.num_rows - node.top_rows;
  const double* factors = panel + node.OwnWidth();
  kernels_.scatter_subtract(below, node.width, {factors, 1, stride}, own, X,
                            rows);
  kernels_.scatter_subtract(node.top_rows, node.width,
                            {factors + below, 1, stride}, own, top,
                            rows + below);
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

// Branches write what they subtract from the top beside it; it is added in
// their order.
absl::Status SupernodalFactor::Solve(double* X, Team& team,
                                     const CancelToken& cancel) const {
  const auto& nodes = structure_.supernodes;
  const auto& branches = structure_.branches;
  const size_t top_begin = static_cast<size_t>(structure_.top_column) * kBlock;
  const size_t top_size =
      static_cast<size_t>(structure_.n) * kBlock - top_begin;
  std::vector<std::vector<double>> tops(branches.size());
  const int count = static_cast<int>(branches.size());
  team.For(count, [&](int b) {
    tops[b].assign(top_size, 0.0);
    for (int k = branches[b].begin;
         k < branches[b].end && !cancel.IsCancelled(); ++k)
      SolveDown(nodes[k], X, tops[b].data() - top_begin);
  });
  MARROW_RETURN_IF_ERROR(cancel.Check());
  for (const std::vector<double>& top : tops)
    for (size_t i = 0; i < top_size; ++i) X[top_begin + i] += top[i];
  const int num_nodes = static_cast<int>(nodes.size());
  for (int k = structure_.first_top; k < num_nodes && !cancel.IsCancelled();
       ++k)
    SolveDown(nodes[k], X, X);
  for (int k = num_nodes; k-- > structure_.first_top && !cancel.IsCancelled();)
    SolveUp(nodes[k], X);
  team.For(count, [&](int b) {
    for (int k = branches[b].end;
         k-- > branches[b].begin && !cancel.IsCancelled();)
      SolveUp(nodes[k], X);
  });
  return cancel.Check();
}

}  // namespace marrow
