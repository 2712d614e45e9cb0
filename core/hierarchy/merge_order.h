// Pieces merged across their weakest boundaries first, and the cuts of what
// that gives: pure data.
//
// Salience, 0 to 1, is the strength of the boundary across which two groups
// merge, or that of an earlier merge where that is greater: strengths are
// measured again after every merge and may fall. So it never falls along the
// merges, every threshold gives one cut, cuts of a lower threshold refine those
// of a higher, and, being a probability, it compares between meshes.
#ifndef MARROW_CORE_HIERARCHY_MERGE_ORDER_H_
#define MARROW_CORE_HIERARCHY_MERGE_ORDER_H_

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/boundaries/boundary_meter.h"
#include "core/boundaries/piece_graph.h"

namespace marrow {

struct PieceMerge {
  uint32_t a = 0;  // least pieces of the two groups, a < b;
  uint32_t b = 0;  // a is that of the group they make
  double salience = 0;
};

// Invariants: every merge joins two groups; salience never falls. Pieces that
// share no edge and no link, directly or through others, merge last.
struct MergeOrder {
  uint32_t num_pieces = 0;
  std::vector<PieceMerge> merges;

  // Piece -> least piece of its group, where all merges of less salience than
  // `threshold` have been made.
  std::vector<uint32_t> CutAt(double threshold) const;
  // The finest cut of a threshold that has at most `count` groups; the coarsest
  // where there is none. REQUIRES: count > 0.
  std::vector<uint32_t> CutInto(uint32_t count) const;
  // Its threshold: the least salience of a merge that it does not make,
  // infinity where it makes all.
  double ThresholdInto(uint32_t count) const;
  // Least piece -> salience of the last merge within the group of the cut; 0
  // for a group of one piece.
  std::vector<double> InnerSalience(const std::vector<uint32_t>& cut) const;
};

// Merges until one group is left, or no boundary of less salience than `end`.
// Equal strengths merge in the order of their pairs. Errors: CANCELLED.
absl::StatusOr<MergeOrder> MergePieces(
    PieceGraph graph, BoundaryMeter& meter, const CancelToken& cancel,
    double end = std::numeric_limits<double>::infinity());

}  // namespace marrow

#endif  // MARROW_CORE_HIERARCHY_MERGE_ORDER_H_
