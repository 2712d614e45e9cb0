// Multifrontal elimination: a supernode gathers the updates of its children and
// its entries, eliminates its columns densely and passes one update on. All of
// it works on the transpose, upper and row-major: what is below a pivot's
// column is to the right of its row, contiguous.
//
// A solve is a walk through memory: what a factor has is read once down and
// once up, and a CPU does little with it. So the triangles are inverted and
// multiplied into what is below them, and all is kept as the solves read it:
// products of matrices alone, from the first double to the last.
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

// Rows of a block that are eliminated before the others of it are updated.
constexpr int kStepRows = 8;
// Rows of the trailing triangle updated at a time.
constexpr int kTileRows = 32;
// Columns of a block's rows worked on at a time; a multiple of kPad.
constexpr int kTileColumns = 128;
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
      packed_(structure.packed_doubles),
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
  work.panel.assign(node.PanelSize(), 0.0);
  work.front.assign(UpdateSize(node), 0.0);
  double* panel = work.panel.data();
  const uint32_t* offset = structure_.offsets.data() + node.entries;
  for (int i = node.first; i < node.first + node.width; ++i)
    for (size_t e = structure_.diagonal[i]; e < structure_.row_start[i + 1];
         ++e)
      panel[*offset++] = structure_.values[e];
  for (int i = 0; i < node.width; ++i)
    panel[static_cast<size_t>(i) * node.PanelStride() + i] -= shift_;
  if (index >= structure_.first_top)
    for (Workspace& branch : branches_) {
      if (branch.waiting.empty()) continue;
      const Supernode& root = structure_.supernodes[branch.waiting.back()];
      if (root.parent == index)
        AddUpdate(root, branch.stack.data(), node, work);
    }
  while (!work.waiting.empty() &&
         structure_.supernodes[work.waiting.back()].parent == index) {
    const Supernode& child = structure_.supernodes[work.waiting.back()];
    const size_t rest = work.stack.size() - UpdateSize(child);
    AddUpdate(child, work.stack.data() + rest, node, work);
    work.stack.resize(rest);
    work.waiting.pop_back();
  }
}

void SupernodalFactor::AddUpdate(const Supernode& child, const double* update,
                                 const Supernode& parent,
                                 Workspace& work) const {
  const int* to = structure_.relative.data() + child.rows;
  double* panel = work.panel.data();
  double* front = work.front.data();
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
  double* packed = packed_.data() + node.packed;
  work.scaled.resize(std::max(work.scaled.size(),
                              std::min(kBlockColumns, node.width) * stride));
  for (int begin = 0; begin < node.width; begin += kBlockColumns) {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    const int end = std::min(begin + kBlockColumns, node.width);
    for (int step = begin; step < end; step += kStepRows)
      MARROW_RETURN_IF_ERROR(EliminateStep(
          node, step, std::min(step + kStepRows, end), end, work));
    UpdateBelow(node, begin, end, work, team);
    InvertTriangle(node, begin, end, work, team);
    packed = Pack(node, begin, end, work.scaled.data(), packed);
  }
  return absl::OkStatus();
}

// Rows `begin` up to `end`; then these are subtracted from the other rows of
// their block. work.scaled receives the rows over their pivots.
absl::Status SupernodalFactor::EliminateStep(const Supernode& node, int begin,
                                             int end, int block_end,
                                             Workspace& work) {
  const int stride = node.PanelStride();
  double* panel = work.panel.data();
  double* scaled =
      work.scaled.data() + static_cast<size_t>(begin % kBlockColumns) * stride;
  for (int k = begin; k < end; ++k) {
    double* row = panel + static_cast<size_t>(k) * stride;
    const double pivot = row[k];
    const double scale = structure_.values[structure_.diagonal[node.first + k]];
    if (!(std::abs(pivot) > kLeastPivot * std::abs(scale)))
      return absl::FailedPreconditionError(
          absl::StrCat("no pivot at the shift ", shift_));
    work.negative_pivots += pivot < 0;
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
  double* panel = work.panel.data();
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

// With T' the unit triangle of the block: its rows become T'^-1 times
// themselves, and the triangle T'^-1.
void SupernodalFactor::InvertTriangle(const Supernode& node, int begin, int end,
                                      Workspace& work, Team& team) const {
  const int stride = node.PanelStride(), count = end - begin;
  double triangle[kBlockColumns * kBlockColumns];
  for (int i = 0; i < count; ++i) {
    double* own = work.scaled.data() + static_cast<size_t>(i) * stride + begin;
    std::copy_n(own, count, triangle + ptrdiff_t{i} * kBlockColumns);
    std::fill_n(own, count, 0.0);
    own[i] = 1;
  }
  const auto solve = [&](int from, int columns) {
    double* rows = work.scaled.data() + from;
    const auto subtract = [&](int first, int last, int used, int used_end) {
      kernels_.multiply_subtract(
          last - first, columns, used_end - used,
          {triangle + ptrdiff_t{first} * kBlockColumns + used, kBlockColumns,
           1},
          rows + static_cast<size_t>(used) * stride, stride,
          rows + static_cast<size_t>(first) * stride, stride);
    };
    for (int step = (count - 1) / kStepRows * kStepRows; step >= 0;
         step -= kStepRows) {
      const int step_end = std::min(step + kStepRows, count);
      subtract(step, step_end, step_end, count);
      for (int i = step_end - 1; i-- > step;)
        subtract(i, i + 1, i + 1, step_end);
    }
  };
  const int first = PadDown(begin);
  const int tiles = (stride - first + kTileColumns - 1) / kTileColumns;
  const auto solve_tile = [&](int tile) {
    const int from = first + tile * kTileColumns;
    solve(from, std::min(kTileColumns, stride - from));
  };
  if (static_cast<double>(count) * count * stride > kTeamWork) {
    team.For(tiles, solve_tile);
  } else {
    for (int tile = 0; tile < tiles; ++tile) solve_tile(tile);
  }
}

// Returns where the next block begins.
double* SupernodalFactor::Pack(const Supernode& node, int begin, int end,
                               const double* scaled, double* out) const {
  const size_t stride = node.PanelStride();
  const int count = end - begin;
  const auto pack_tile = [&](int column, int rows, int columns) {
    for (int l = 0; l < columns; ++l)
      for (int r = 0; r < kTile; ++r)
        *out++ = r < rows ? scaled[l * stride + column + r] : 0;
  };
  const auto pack = [&](int column, int rows) {
    for (int i = 0; i < rows; i += kTile)
      pack_tile(column + i, rows - i, count);
  };
  const int below = node.num_rows - node.top_rows;
  pack(end, node.width - end);
  pack(node.OwnWidth(), below);
  pack(node.OwnWidth() + below, node.top_rows);
  for (int i = (count - 1) / kTile * kTile; i >= 0; i -= kTile)
    pack_tile(begin + i, count - i, TriangleTileColumns(count, i));
  return out;
}

void SupernodalFactor::PushUpdate(int index, Workspace& work) const {
  const Supernode& node = structure_.supernodes[index];
  work.stack.insert(work.stack.end(), work.front.begin(),
                    work.front.begin() + UpdateSize(node));
  work.waiting.push_back(index);
}

void SupernodalFactor::SolveDown(const Supernode& node, double* X,
                                 double* top) const {
  const double* P = packed_.data() + node.packed;
  const int* rows = structure_.rows.data() + node.rows;
  const int below = node.num_rows - node.top_rows;
  for (int begin = 0; begin < node.width; begin += kBlockColumns) {
    const int end = std::min(begin + kBlockColumns, node.width);
    const int k = end - begin;
    double* own = X + static_cast<size_t>(node.first + begin) * kBlock;
    kernels_.tiles_down(node.width - end, k, P, own,
                        own + static_cast<size_t>(k) * kBlock, nullptr);
    P += TilesSize(node.width - end, k);
    kernels_.tiles_down(below, k, P, own, X, rows);
    P += TilesSize(below, k);
    kernels_.tiles_down(node.top_rows, k, P, own, top, rows + below);
    P += TilesSize(node.top_rows, k);
    kernels_.triangle_down(k, P, own);
    P += TriangleSize(k);
  }
}

void SupernodalFactor::SolveUp(const Supernode& node, double* X) const {
  const double* P = packed_.data() + node.packed + node.PackedSize();
  const int* rows = structure_.rows.data() + node.rows;
  const int below = node.num_rows - node.top_rows;
  alignas(64) double sum[kBlockColumns * kBlock];
  for (int begin = (node.width - 1) / kBlockColumns * kBlockColumns; begin >= 0;
       begin -= kBlockColumns) {
    const int end = std::min(begin + kBlockColumns, node.width);
    const int k = end - begin;
    const size_t near = TilesSize(node.width - end, k);
    const size_t far = TilesSize(below, k);
    const size_t top = TilesSize(node.top_rows, k);
    P -= near + far + top + TriangleSize(k);
    double* own = X + static_cast<size_t>(node.first + begin) * kBlock;
    std::fill_n(sum, k * kBlock, 0.0);
    kernels_.tiles_up(node.width - end, k, P,
                      own + static_cast<size_t>(k) * kBlock, nullptr, sum);
    kernels_.tiles_up(below, k, P + near, X, rows, sum);
    kernels_.tiles_up(node.top_rows, k, P + near + far, X, rows + below, sum);
    kernels_.triangle_up(k, P + near + far + top,
                         inverse_pivots_.data() + node.first + begin, sum, own);
  }
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
