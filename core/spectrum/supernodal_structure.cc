// The elimination tree after Liu, column counts by walking the row subtrees,
// and two ways of joining columns: whole small subtrees at the leaves, where
// panels would otherwise be a column wide, and chains of supernodes that differ
// by little. Both trade a few zeros for dense work.
#include "core/spectrum/supernodal_structure.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/status_macros.h"
#include "core/spectrum/ordering.h"

namespace marrow {
namespace {

// Subtrees up to this many columns become one supernode.
constexpr int kLeafColumns = 8;
// A child is joined to its parent while zeros are at most this share of the
// panel; under kSmallWidth columns, at most kSmallShare.
constexpr double kZeroShare = 0.12;
constexpr double kSmallShare = 0.3;
constexpr int kSmallWidth = 24;
constexpr int kCheckEvery = 1 << 16;
// Matrices of at least this many rows have branches, none of which has more
// than the share of the work. A supernode costs so many operations besides.
constexpr int kBranchedRows = 300'000;
constexpr double kBranchShare = 0.06;
constexpr double kRunWork = 4000;

// Lower neighbours (in the new order) of every vertex.
struct LowerGraph {
  std::vector<size_t> start;
  std::vector<int> neighbours;
};

absl::StatusOr<Graph> GraphOf(const Eigen::SparseMatrix<double>& matrix,
                              const CancelToken& cancel) {
  Graph graph;
  const int n = static_cast<int>(matrix.rows());
  graph.start.assign(n + 1, 0);
  graph.neighbours.reserve(matrix.nonZeros());
  for (int v = 0; v < n; ++v) {
    if (v % kCheckEvery == 0) MARROW_RETURN_IF_ERROR(cancel.Check());
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, v); it; ++it)
      if (it.row() != v) graph.neighbours.push_back(it.row());
    graph.start[v + 1] = static_cast<int>(graph.neighbours.size());
  }
  return graph;
}

absl::StatusOr<LowerGraph> LowerGraphOf(const Graph& graph,
                                        const std::vector<int>& order,
                                        const CancelToken& cancel) {
  const int n = graph.NumVertices();
  std::vector<int> position(n);
  for (int i = 0; i < n; ++i) position[order[i]] = i;
  LowerGraph lower;
  lower.start.assign(n + 1, 0);
  lower.neighbours.reserve(graph.neighbours.size() / 2);
  for (int i = 0; i < n; ++i) {
    if (i % kCheckEvery == 0) MARROW_RETURN_IF_ERROR(cancel.Check());
    const int v = order[i];
    for (int e = graph.start[v]; e < graph.start[v + 1]; ++e)
      if (position[graph.neighbours[e]] < i)
        lower.neighbours.push_back(position[graph.neighbours[e]]);
    lower.start[i + 1] = lower.neighbours.size();
  }
  return lower;
}

std::vector<int> EliminationTree(const LowerGraph& lower) {
  const int n = static_cast<int>(lower.start.size()) - 1;
  std::vector<int> parent(n, -1), ancestor(n, -1);
  for (int i = 0; i < n; ++i)
    for (size_t e = lower.start[i]; e < lower.start[i + 1]; ++e)
      for (int v = lower.neighbours[e]; v != i && v >= 0;) {
        const int next = ancestor[v];
        ancestor[v] = i;
        if (next < 0) parent[v] = i;
        v = next;
      }
  return parent;
}

// Children before parents, each subtree a run; old -> position.
std::vector<int> Postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> first_child(n + 1, -1), next(n, -1), order;
  order.reserve(n);
  for (int v = n - 1; v >= 0; --v) {
    const int p = parent[v] < 0 ? n : parent[v];
    next[v] = first_child[p];
    first_child[p] = v;
  }
  std::vector<int> stack;
  for (int root = first_child[n]; root >= 0; root = next[root]) {
    stack.push_back(root);
    while (!stack.empty()) {
      const int v = stack.back();
      if (const int child = first_child[v]; child >= 0) {
        first_child[v] = next[child];
        stack.push_back(child);
      } else {
        order.push_back(v);
        stack.pop_back();
      }
    }
  }
  return order;
}

// Entries of each column of the factor, the diagonal counted.
absl::StatusOr<std::vector<int>> ColumnCounts(const LowerGraph& lower,
                                              const std::vector<int>& parent,
                                              size_t most,
                                              const CancelToken& cancel) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> counts(n, 1), mark(n, -1);
  size_t total = 0, asked = 0;
  for (int i = 0; i < n; ++i) {
    mark[i] = i;
    for (size_t e = lower.start[i]; e < lower.start[i + 1]; ++e)
      for (int v = lower.neighbours[e]; mark[v] != i; v = parent[v]) {
        mark[v] = i;
        ++counts[v];
        ++total;
      }
    if (total > most) {
      return absl::ResourceExhaustedError(
          absl::StrCat("the mesh of ", n,
                       " vertices is too entangled to be factorised: "
                       "more than ",
                       most, " entries; is it a surface?"));
    }
    if (total - asked > kCheckEvery) {
      asked = total;
      MARROW_RETURN_IF_ERROR(cancel.Check());
    }
  }
  return counts;
}

struct Run {
  int first;
  int width;
  int num_rows;
};

// Marks the last columns of maximal small subtrees.
std::vector<Run> LeafRuns(const std::vector<int>& parent,
                          const std::vector<int>& counts) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> size(n, 1);
  for (int v = 0; v < n; ++v)
    if (parent[v] >= 0) size[parent[v]] += size[v];
  std::vector<Run> runs;
  for (int v = 0; v < n; ++v) {
    if (size[v] > kLeafColumns) {
      // A column joins the one before if their structures are one.
      const bool same = !runs.empty() && size[v - 1] > kLeafColumns &&
                        parent[v - 1] == v && counts[v - 1] == counts[v] + 1;
      if (same) {
        ++runs.back().width;
        runs.back().num_rows = counts[v] - 1;
      } else {
        runs.push_back({v, 1, counts[v] - 1});
      }
    } else if (parent[v] < 0 || size[parent[v]] > kLeafColumns) {
      runs.push_back({v - size[v] + 1, size[v], counts[v] - 1});
    }
  }
  return runs;
}

double Area(double width, double rows) {
  return width * (width + 1) / 2 + width * rows;
}

// Joins a run to the one before it where that is its child and few zeros come
// of it. `zeros` are those that a run has taken in already.
std::vector<Run> JoinChains(const std::vector<Run>& runs,
                            const std::vector<int>& parent) {
  std::vector<Run> joined;
  std::vector<double> zeros;
  for (Run run : runs) {
    double own = 0;
    while (!joined.empty()) {
      const Run& child = joined.back();
      const int last = child.first + child.width - 1;
      if (parent[last] < run.first || parent[last] >= run.first + run.width)
        break;
      const double whole = Area(child.width + run.width, run.num_rows);
      const double more = whole - Area(child.width, child.num_rows) -
                          Area(run.width, run.num_rows);
      const double sum = own + zeros.back() + more;
      const double share =
          child.width + run.width <= kSmallWidth ? kSmallShare : kZeroShare;
      if (sum > share * whole) break;
      own = sum;
      run = {child.first, child.width + run.width, run.num_rows};
      joined.pop_back();
      zeros.pop_back();
    }
    joined.push_back(run);
    zeros.push_back(own);
  }
  return joined;
}

using Structure = SupernodalStructure;

void PlaceSupernodes(const std::vector<Run>& runs, Structure& s) {
  size_t rows = 0;
  for (const Run& run : runs) {
    Structure::Supernode node{};
    node.first = run.first;
    node.width = run.width;
    node.num_rows = run.num_rows;
    node.parent = -1;
    node.rows = rows;
    rows += run.num_rows;
    s.supernodes.push_back(node);
  }
  s.rows.resize(rows);
  s.relative.resize(rows);
}

// Fills the rows of every supernode from its children and its entries.
absl::Status FindRows(Structure& s, const CancelToken& cancel) {
  const int count = static_cast<int>(s.supernodes.size());
  std::vector<int> node_of(s.n);
  for (int k = 0; k < count; ++k)
    std::fill_n(node_of.begin() + s.supernodes[k].first, s.supernodes[k].width,
                k);
  std::vector<int> first_child(count, -1), next(count, -1), mark(s.n, -1);
  for (int k = 0; k < count; ++k) {
    Structure::Supernode& node = s.supernodes[k];
    const int end = node.first + node.width;
    int* out = s.rows.data() + node.rows;
    int* const begin = out;
    const auto add = [&](int row) {
      if (row < end || mark[row] == k) return;
      mark[row] = k;
      *out++ = row;
    };
    for (int i = node.first; i < end; ++i)
      for (size_t e = s.diagonal[i]; e < s.row_start[i + 1]; ++e)
        add(s.columns[e]);
    for (int child = first_child[k]; child >= 0; child = next[child]) {
      const Structure::Supernode& c = s.supernodes[child];
      for (int i = 0; i < c.num_rows; ++i) add(s.rows[c.rows + i]);
    }
    std::sort(begin, out);
    if (k < s.first_top)
      node.top_rows =
          static_cast<int>(out - std::lower_bound(begin, out, s.top_column));
    // Leaf runs count their last column's structure, which holds all of it.
    if (out - begin != node.num_rows)
      return absl::InternalError("the symbolic analysis lost count");
    if (node.num_rows > 0) {
      node.parent = node_of[*begin];
      next[k] = first_child[node.parent];
      first_child[node.parent] = k;
    }
    node.packed = s.packed_doubles;
    s.packed_doubles += node.PackedSize();
    if (k % 1024 == 0) MARROW_RETURN_IF_ERROR(cancel.Check());
  }
  return absl::OkStatus();
}

// Where `row` is in a panel; `cursor` is the first of the supernode's rows that
// may be it, and moves on.
int PanelColumn(const Structure& s, const Structure::Supernode& node, int row,
                int& cursor) {
  if (row < node.first + node.width) return row - node.first;
  while (s.rows[node.rows + cursor] != row) ++cursor;
  return node.OwnWidth() + cursor;
}

absl::Status FindRelative(Structure& s, const CancelToken& cancel) {
  for (const Structure::Supernode& node : s.supernodes) {
    if (cancel.IsCancelled()) return cancel.Check();
    if (node.parent < 0) continue;
    int cursor = 0;
    for (int i = 0; i < node.num_rows; ++i)
      s.relative[node.rows + i] = PanelColumn(s, s.supernodes[node.parent],
                                              s.rows[node.rows + i], cursor);
  }
  return absl::OkStatus();
}

absl::Status FindOffsets(Structure& s, const CancelToken& cancel) {
  s.offsets.reserve((s.columns.size() + s.n) / 2);
  for (Structure::Supernode& node : s.supernodes) {
    if (cancel.IsCancelled()) return cancel.Check();
    node.entries = s.offsets.size();
    for (int i = node.first; i < node.first + node.width; ++i) {
      int cursor = 0;
      for (size_t e = s.diagonal[i]; e < s.row_start[i + 1]; ++e)
        s.offsets.push_back(static_cast<uint32_t>(
            static_cast<size_t>(i - node.first) * node.PanelStride() +
            PanelColumn(s, node, s.columns[e], cursor)));
    }
  }
  return absl::OkStatus();
}

// The rows in the new order.
absl::Status CopyEntries(const Eigen::SparseMatrix<double>& matrix,
                         Structure& s, const CancelToken& cancel) {
  std::vector<int> position(s.n);
  for (int i = 0; i < s.n; ++i) position[s.order[i]] = i;
  s.row_start.assign(s.n + 1, 0);
  s.columns.reserve(matrix.nonZeros());
  s.values.reserve(matrix.nonZeros());
  std::vector<std::pair<int, double>> row;
  for (int i = 0; i < s.n; ++i) {
    if (i % kCheckEvery == 0) MARROW_RETURN_IF_ERROR(cancel.Check());
    row.clear();
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, s.order[i]); it;
         ++it)
      row.push_back({position[it.row()], it.value()});
    std::sort(row.begin(), row.end());
    for (const auto& [column, value] : row) {
      if (column == i) s.diagonal.push_back(s.columns.size());
      s.columns.push_back(column);
      s.values.push_back(value);
    }
    s.row_start[i + 1] = s.columns.size();
  }
  return absl::OkStatus();
}

// The run that each run's update goes to, or -1.
std::vector<int> ParentRuns(const std::vector<Run>& runs,
                            const std::vector<int>& parent) {
  std::vector<int> run_of(parent.size());
  for (size_t k = 0; k < runs.size(); ++k)
    std::fill_n(run_of.begin() + runs[k].first, runs[k].width,
                static_cast<int>(k));
  std::vector<int> result;
  for (const Run& run : runs) {
    const int up = parent[run.first + run.width - 1];
    result.push_back(up < 0 ? -1 : run_of[up]);
  }
  return result;
}

// Chooses branches: the heaviest subtree is cut at its root until none has more
// than kBranchShare of the work. Moves them before the rest.
void MoveBranches(const std::vector<int>& parent, std::vector<Run>& runs,
                  Structure& s) {
  const int count = static_cast<int>(runs.size());
  const std::vector<int> up = ParentRuns(runs, parent);
  std::vector<double> work(count, 0.0);
  std::vector<int> begin(count);
  std::iota(begin.begin(), begin.end(), 0);
  double total = 0;
  for (int k = 0; k < count; ++k) {
    const double side = runs[k].width + runs[k].num_rows;
    work[k] += runs[k].width * side * side + kRunWork;
    total += runs[k].width * side * side + kRunWork;
    if (up[k] < 0) continue;
    work[up[k]] += work[k];
    begin[up[k]] = std::min(begin[up[k]], begin[k]);
  }
  std::vector<bool> is_top(count, false);
  for (int k = count - 1; k >= 0;) {
    if (work[k] > kBranchShare * total) {
      is_top[k--] = true;
      continue;
    }
    s.branches.push_back({begin[k], k + 1});
    k = begin[k] - 1;
  }
  std::reverse(s.branches.begin(), s.branches.end());

  std::vector<Run> moved;
  std::vector<int> order;
  const auto take = [&](int k) {
    Run run = runs[k];
    for (int c = run.first; c < run.first + run.width; ++c)
      order.push_back(s.order[c]);
    run.first = static_cast<int>(order.size()) - run.width;
    moved.push_back(run);
  };
  for (Structure::Branch& branch : s.branches) {
    const int first = static_cast<int>(moved.size());
    for (int k = branch.begin; k < branch.end; ++k) take(k);
    branch = {first, static_cast<int>(moved.size())};
  }
  s.first_top = static_cast<int>(moved.size());
  s.top_column = static_cast<int>(order.size());
  for (int k = 0; k < count; ++k)
    if (is_top[k]) take(k);
  runs = std::move(moved);
  s.order = std::move(order);
}

}  // namespace

absl::StatusOr<SupernodalStructure> AnalyseStructure(
    const Eigen::SparseMatrix<double>& matrix, const double* positions,
    size_t max_factor_bytes, int threads, const CancelToken& cancel) {
  SupernodalStructure s;
  s.n = static_cast<int>(matrix.rows());
  MARROW_ASSIGN_OR_RETURN(const Graph graph, GraphOf(matrix, cancel));
  MARROW_ASSIGN_OR_RETURN(s.order,
                          DissectionOrder(graph, positions, threads, cancel));
  // The tree keeps its shape when its vertices are renumbered by postorder.
  MARROW_ASSIGN_OR_RETURN(LowerGraph lower,
                          LowerGraphOf(graph, s.order, cancel));
  const std::vector<int> postorder = Postorder(EliminationTree(lower));
  std::vector<int> reordered(s.n);
  for (int i = 0; i < s.n; ++i) reordered[i] = s.order[postorder[i]];
  s.order = std::move(reordered);
  MARROW_ASSIGN_OR_RETURN(lower, LowerGraphOf(graph, s.order, cancel));
  const std::vector<int> parent = EliminationTree(lower);
  MARROW_ASSIGN_OR_RETURN(
      const std::vector<int> counts,
      ColumnCounts(lower, parent, max_factor_bytes / sizeof(double), cancel));
  std::vector<Run> runs = JoinChains(LeafRuns(parent, counts), parent);
  if (s.n >= kBranchedRows) MoveBranches(parent, runs, s);
  MARROW_RETURN_IF_ERROR(CopyEntries(matrix, s, cancel));
  PlaceSupernodes(runs, s);
  MARROW_RETURN_IF_ERROR(FindRows(s, cancel));
  MARROW_RETURN_IF_ERROR(FindRelative(s, cancel));
  MARROW_RETURN_IF_ERROR(FindOffsets(s, cancel));
  return s;
}

size_t SupernodalStructure::Supernode::PackedSize() const {
  size_t size = 0;
  for (int begin = 0; begin < width; begin += kBlockColumns) {
    const int end = std::min(begin + kBlockColumns, width), k = end - begin;
    size += TilesSize(width - end, k) + TilesSize(num_rows - top_rows, k) +
            TilesSize(top_rows, k) + TriangleSize(k);
  }
  return size;
}

void SupernodalStructure::SubtractProduct(const double* X, double* Y) const {
  Kernels().sparse_subtract(n, row_start.data(), columns.data(), values.data(),
                            X, Y);
}

}  // namespace marrow
