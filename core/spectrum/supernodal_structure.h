// What the factors L D L' of all shifts of one matrix have in common: the order
// of the unknowns, the columns that are kept together, and where what goes.
#ifndef MARROW_CORE_SPECTRUM_SUPERNODAL_STRUCTURE_H_
#define MARROW_CORE_SPECTRUM_SUPERNODAL_STRUCTURE_H_

#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/spectrum/dense_kernels.h"

namespace marrow {

// So many columns of a supernode are eliminated at a time, and solved at a
// time.
inline constexpr int kBlockColumns = 64;

// Immutable once built; the threads of a solve share it.
//
// A supernode is a run of columns with one structure below them. While it is
// eliminated, it is in a panel, the transpose of those columns: a row a column,
// first the columns' own triangle, padded to a multiple of kPad, then the rows
// below them, padded too. What is left of it for the solves is packed: for
// every kBlockColumns columns, with T their own unit triangle, the tiles of
// B T^-1, where B has the supernode's later columns, the rows below that are
// not in the top and those that are, each by themselves; and then T^-1.
struct SupernodalStructure {
  struct Supernode {
    int first;       // column
    int width;       // columns
    int parent;      // the supernode that takes its update, or -1
    int num_rows;    // below the columns
    int top_rows;    // of a branch's: as many of them are in the top
    size_t rows;     // where they begin in `rows` and `relative`
    size_t packed;   // where its factors begin, in doubles
    size_t entries;  // where they begin in `offsets`
    int OwnWidth() const { return PadUp(width); }
    int PanelStride() const { return PadUp(width) + PadUp(num_rows); }
    size_t PanelSize() const {
      return static_cast<size_t>(width) * PanelStride();
    }
    size_t PackedSize() const;
  };

  // A subtree that a thread may have for itself: a run of supernodes.
  struct Branch {
    int begin;
    int end;
  };

  int n = 0;
  std::vector<int> order;  // new -> old
  // Every supernode comes after its children; the branches, which large
  // matrices have, come first, then the top, which takes their updates.
  std::vector<Supernode> supernodes;
  std::vector<Branch> branches;
  int first_top = 0;          // supernode
  int top_column = 0;         // of the first of those
  std::vector<int> rows;      // ascending within a supernode
  std::vector<int> relative;  // of a row, its column in the parent's panel
  // The matrix in the new order, by rows: entry e of row i, row_start[i] <= e <
  // row_start[i + 1], ascending; those from diagonal[i] on are in the upper
  // triangle.
  std::vector<size_t> row_start;
  std::vector<size_t> diagonal;
  std::vector<int> columns;
  std::vector<double> values;
  // Where the upper triangle's entries, row by row, are in their panels.
  std::vector<uint32_t> offsets;
  size_t packed_doubles = 0;

  // Y -= A X for one block of vectors.
  void SubtractProduct(const double* X, double* Y) const;
};

// `matrix` is symmetric with a full pattern and diagonal; `positions` has a row
// of three an unknown and guides the order. Errors: CANCELLED;
// RESOURCE_EXHAUSTED where a factor would take more than `max_factor_bytes`,
// which only a mesh far from a surface can do.
absl::StatusOr<SupernodalStructure> AnalyseStructure(
    const Eigen::SparseMatrix<double>& matrix, const double* positions,
    size_t max_factor_bytes, int threads, const CancelToken& cancel);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_SUPERNODAL_STRUCTURE_H_
