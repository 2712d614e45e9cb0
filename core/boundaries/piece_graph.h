// Pieces, the boundaries between them, and what becomes of both as they merge.
#ifndef MARROW_CORE_BOUNDARIES_PIECE_GRAPH_H_
#define MARROW_CORE_BOUNDARIES_PIECE_GRAPH_H_

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/mesh/adjacency.h"
#include "core/pieces/face_links.h"

namespace marrow {

// Groups of pieces. A group is named by its least piece; at first every piece
// is a group of its own. Two groups have a boundary where an edge has faces of
// both, or a link joins faces of both. Not thread safe.
//
// Invariants: the groups partition the faces; every edge whose faces are of
// different groups is in the boundary of each such pair, once. A boundary of
// links alone has no edges.
class PieceGraph {
 public:
  // The lesser group first.
  using Pair = std::pair<uint32_t, uint32_t>;
  // Edges, ascending.
  using Boundary = std::vector<uint32_t>;

  // `piece_of_face`: every number from 0 to the greatest has a face.
  // `face_areas` are shares of the whole area.
  PieceGraph(const Adjacency& adjacency, std::vector<uint32_t> piece_of_face,
             const std::vector<double>& face_areas,
             const FaceLinks& links = {});

  // `segment_of_face` are the segments that the body was split into first. To
  // be called before any merge.
  void SetFirstSplit(const std::vector<uint32_t>& segment_of_face,
                     const std::vector<double>& face_areas);

  uint32_t NumPieces() const { return static_cast<uint32_t>(areas_.size()); }
  // Face -> its group.
  const std::vector<uint32_t>& group_of_face() const { return group_of_face_; }
  double Area(uint32_t group) const { return areas_[group]; }
  // That of all shells of which the group has faces: what edges connect.
  double AreaOfShells(uint32_t group) const;
  // How much of two groups is in different segments of the first split, 0 to 1:
  // 1 - sum over the segments of the lesser of their shares of either group. A
  // boundary of the two need not be one of the segments to be between them, as
  // boundaries move. 0 without a first split.
  double ApartInFirstSplit(const Pair& groups) const;
  const std::map<Pair, Boundary>& boundaries() const { return boundaries_; }

  // Those that have a boundary with the group.
  const std::set<uint32_t>& Neighbours(uint32_t group) const {
    return neighbours_[group];
  }

  // Those that are left, ascending.
  std::vector<uint32_t> Groups() const;

  // Makes one group, a, of the groups a < b. Time: that of b and its
  // boundaries.
  void Merge(uint32_t a, uint32_t b);

 private:
  void FindShells(const Adjacency& adjacency,
                  const std::vector<double>& face_areas);
  void MergeBoundaries(uint32_t a, uint32_t b);

  std::vector<uint32_t> group_of_face_;
  std::vector<std::vector<uint32_t>> faces_;
  std::vector<double> areas_;
  // Where there are links: the shells of each group, ascending, and the area of
  // each shell.
  std::vector<std::set<uint32_t>> shells_;
  std::vector<double> shell_areas_;
  std::vector<double> areas_of_shells_;  // of each group
  // Of each group, in each segment of the first split.
  std::vector<std::map<uint32_t, double>> split_areas_;
  std::map<Pair, Boundary> boundaries_;
  std::vector<std::set<uint32_t>> neighbours_;
};

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_PIECE_GRAPH_H_
