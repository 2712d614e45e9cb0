#include "core/hierarchy/merge_order.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

// The boundaries of a graph by strength, the weakest first; of equal ones that
// of the least pair.
class Strengths {
 public:
  Strengths(const PieceGraph& graph, BoundaryMeter& meter)
      : graph_(graph), meter_(meter) {}

  bool empty() const { return queue_.empty(); }
  std::pair<double, PieceGraph::Pair> Weakest() const {
    return *queue_.begin();
  }
  void Measure(const PieceGraph::Pair& pair) {
    Forget(pair);
    const double strength = meter_.StrengthBetween(graph_, pair);
    strength_[pair] = strength;
    queue_.insert({strength, pair});
  }
  void Forget(const PieceGraph::Pair& pair) {
    const auto known = strength_.find(pair);
    if (known == strength_.end()) return;
    queue_.erase({known->second, pair});
    strength_.erase(known);
  }

 private:
  const PieceGraph& graph_;
  BoundaryMeter& meter_;
  std::map<PieceGraph::Pair, double> strength_;
  std::set<std::pair<double, PieceGraph::Pair>> queue_;
};

// Merges, and measures the boundaries of what comes of it.
void Merge(const PieceGraph::Pair& pair, PieceGraph& graph,
           Strengths& strengths) {
  const auto [a, b] = pair;
  for (uint32_t other : graph.Neighbours(b))
    strengths.Forget(std::minmax(b, other));
  graph.Merge(a, b);
  for (uint32_t other : graph.Neighbours(a))
    strengths.Measure(std::minmax(a, other));
}

// Shells that nothing joins, not even a link: the smallest goes with the
// largest.
void MergeShells(PieceGraph& graph, BoundaryMeter& meter, double end,
                 double salience, MergeOrder& order) {
  std::vector<uint32_t> shells = graph.Groups();
  std::stable_sort(shells.begin(), shells.end(), [&](uint32_t x, uint32_t y) {
    return graph.Area(x) < graph.Area(y);
  });
  uint32_t largest = shells.back();
  shells.pop_back();
  for (uint32_t shell : shells) {
    const PieceGraph::Pair pair = std::minmax(shell, largest);
    salience = std::max(salience, meter.StrengthBetween(graph, pair));
    if (salience >= end) return;
    order.merges.push_back({pair.first, pair.second, salience});
    graph.Merge(pair.first, pair.second);
    largest = pair.first;
  }
}

}  // namespace

std::vector<uint32_t> MergeOrder::CutAt(double threshold) const {
  DisjointSets groups(num_pieces);
  for (const PieceMerge& merge : merges) {
    if (merge.salience >= threshold) break;
    groups.Union(merge.a, merge.b);
  }
  std::vector<uint32_t> cut(num_pieces);
  for (uint32_t p = 0; p < cut.size(); ++p) cut[p] = groups.Find(p);
  return cut;
}

std::vector<uint32_t> MergeOrder::CutInto(uint32_t count) const {
  return CutAt(ThresholdInto(count));
}

double MergeOrder::ThresholdInto(uint32_t count) const {
  size_t made = num_pieces > count ? num_pieces - count : 0;
  made = std::min(made, merges.size());
  // Merges of one salience are made together.
  while (made > 0 && made < merges.size() &&
         merges[made].salience == merges[made - 1].salience)
    ++made;
  return made < merges.size() ? merges[made].salience
                              : std::numeric_limits<double>::infinity();
}

std::vector<double> MergeOrder::InnerSalience(
    const std::vector<uint32_t>& cut) const {
  std::vector<double> salience(num_pieces, 0);
  for (const PieceMerge& merge : merges)
    if (cut[merge.a] == cut[merge.b]) salience[cut[merge.a]] = merge.salience;
  return salience;
}

absl::StatusOr<MergeOrder> MergePieces(PieceGraph graph, BoundaryMeter& meter,
                                       const CancelToken& cancel, double end) {
  MergeOrder order;
  order.num_pieces = graph.NumPieces();
  Strengths strengths(graph, meter);
  for (const auto& [pair, edges] : graph.boundaries()) {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    strengths.Measure(pair);
  }
  double salience = 0;
  while (!strengths.empty()) {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    const auto [strength, pair] = strengths.Weakest();
    salience = std::max(salience, strength);
    if (salience >= end) break;
    order.merges.push_back({pair.first, pair.second, salience});
    Merge(pair, graph, strengths);
  }
  if (strengths.empty()) MergeShells(graph, meter, end, salience, order);
  return order;
}

}  // namespace marrow
