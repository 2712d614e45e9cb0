// Cuts of the tree: which segments to take, and those that come of it.
#ifndef MARROW_CORE_HIERARCHY_CUT_H_
#define MARROW_CORE_HIERARCHY_CUT_H_

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/hierarchy/merge_order.h"
#include "core/hierarchy/segment_tree.h"

namespace marrow {

// How fine a cut is, and where it has to be finer or coarser than that.
struct CutSpec {
  enum class By {
    // Merged pieces: kAutomaticSalience, but no finer than the tree's last
    // level. The paper: level 2, or the last where there are fewer.
    kAutomatic,
    kLevel,  // the segments of `level`; beyond the last, of the last
    // At most `segments`, as many as can be. Merges of one salience are made
    // together or not at all, so that limbs that are equal are treated alike.
    // Several bodies do not merge: there are never fewer segments than bodies.
    // The paper's tree is split from the top, the largest segment first.
    kSegments,
    kSalience,  // every boundary of at least `salience`; merged pieces alone
  };
  By by = By::kAutomatic;
  uint32_t level = 0;
  uint32_t segments = 0;
  double salience = 0;
  // Nodes of the tree. A closed one is never split, however fine the cut; an
  // open one is split into its children at least, and so are those above it.
  std::vector<uint32_t> closed;
  std::vector<uint32_t> open;

  static CutSpec AtLevel(uint32_t level);
  static CutSpec Into(uint32_t segments);
  static CutSpec AtSalience(double salience);
};

// Segments that cover the mesh once.
struct TreeCut {
  struct Segment {
    // That of the tree's node with the same faces, where there is one: of
    // several, the one at the cut's own level. Else, from the number of the
    // tree's nodes on, in the order of the segments' least pieces.
    uint32_t id = 0;
    // The deepest node that has more faces than it, all of its own among them;
    // kNoIndex for the root.
    uint32_t parent = kNoIndex;
    uint32_t level = 0;   // one more than the parent's, 0 for the root
    double salience = 0;  // as SegmentNode::salience
  };
  std::vector<Segment> segments;           // ascending ids
  std::vector<uint32_t> segment_of_piece;  // piece -> index in `segments`
  // The threshold that was cut at: the one asked for, that of the level, or,
  // by number, the least salience of a boundary that is kept (1 where none
  // is). 0 for the paper's tree.
  double salience = 0;
};

// Cuts one tree in any way, without looking at the mesh. Immutable, hence
// thread safe; the tree must outlive it. A cut takes O(pieces log pieces) for
// each level of the tree.
class TreeCutter {
 public:
  // Of merged pieces. REQUIRES: level k of the tree is the order's cut at
  // thresholds[k - 1], as many as were asked for, and the tree's nodes are
  // made of whole pieces.
  TreeCutter(const SegmentTree& tree, std::vector<uint32_t> piece_of_face,
             MergeOrder order, std::vector<double> thresholds);
  // Of the paper's tree, whose leaves are the pieces. Of several bodies, which
  // are the root's children, no number of segments makes one.
  TreeCutter(const SegmentTree& tree, bool several_bodies);

  const std::vector<uint32_t>& piece_of_face() const { return piece_of_face_; }

  // Errors: INVALID_ARGUMENT that names the field, as "cut.open[0]": a node
  // that the tree does not have; an open one that has no children, or that is
  // in a closed one. REQUIRES: the rest of it has passed ValidateCut().
  absl::StatusOr<TreeCut> Apply(const CutSpec& spec) const;

 private:
  // Piece -> least piece of its group.
  using Partition = std::vector<uint32_t>;
  struct Base {
    Partition groups;
    double salience = 0;
    uint32_t level = 0;  // the deepest that the cut is not coarser than
  };

  void FindPiecesOfNodes();
  absl::Status CheckNodes(const CutSpec& spec) const;
  Base MakeBase(const CutSpec& spec) const;
  Base AtSalience(double threshold) const;
  Partition GroupsOf(const std::vector<uint32_t>& nodes) const;
  std::vector<uint32_t> LargestSplitInto(uint32_t count) const;
  void Open(const std::vector<uint32_t>& nodes, Partition& groups) const;
  void Close(const std::vector<uint32_t>& nodes, Partition& groups) const;
  TreeCut Name(const Base& base) const;
  // The node with these pieces, if any; kNoIndex.
  uint32_t NodeOf(uint32_t least_piece, uint32_t num_pieces,
                  uint32_t level) const;
  // The deepest node with more pieces than that, this one among them.
  uint32_t NodeAbove(uint32_t piece, uint32_t num_pieces) const;

  const SegmentTree& tree_;
  std::vector<uint32_t> piece_of_face_;
  const std::optional<MergeOrder> order_;  // none of the paper's tree
  const std::vector<double> thresholds_;
  const uint32_t coarsest_level_;
  uint32_t num_pieces_ = 0;
  std::vector<std::vector<uint32_t>> pieces_of_node_;  // ascending
  // Least piece and number of pieces -> nodes, from the root down. Sets of
  // pieces that share one lie one in the other, so this tells them apart.
  std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> nodes_;
};

}  // namespace marrow

#endif  // MARROW_CORE_HIERARCHY_CUT_H_
