// The flow runs from the sink to the source. Where it is as great as can be,
// the nodes that could still send some to the source are the smallest source
// side of all cuts of least cost; and that is so before what piles up behind
// the cut has been sent back, which is left undone.
#include "core/boundaries/min_cut.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace marrow {
namespace {

constexpr uint32_t kUnreached = std::numeric_limits<uint32_t>::max();
// Room below this share of the greatest is rounding, and no room.
constexpr double kRounding = 1e-12;

}  // namespace

MinCut::MinCut(uint32_t num_nodes) : source_(num_nodes), sink_(num_nodes + 1) {}

void MinCut::Connect(uint32_t a, uint32_t b, double cost) {
  Add({{a, b}, {cost, cost}});
}

void MinCut::ConnectToSource(uint32_t node, double cost) {
  Add({{node, source_}, {cost, 0}});
}

void MinCut::ConnectToSink(uint32_t node, double cost) {
  Add({{sink_, node}, {cost, 0}});
}

void MinCut::Add(const Edge& edge) {
  assert(edge.room[0] >= 0 && edge.room[1] >= 0);
  edges_.push_back(edge);
  least_room_ = std::max(least_room_, kRounding * edge.room[0]);
}

std::vector<MinCut::Side> MinCut::Solve() {
  Sort();
  excess_.assign(sink_ + 1, 0);
  // Full arcs first: the sink then leads nowhere, so nothing is sent back to
  // it.
  for (uint32_t k = first_[sink_]; k < first_[sink_ + 1]; ++k) {
    excess_[sink_] = arcs_[k].room;
    if (excess_[sink_] > 0) Push(sink_, k);
  }
  LabelAll();
  while (!active_.empty()) {
    const uint32_t node = active_.front();
    active_.pop_front();
    Discharge(node);
    if (lifts_ > sink_) LabelAll();
  }
  LabelAll();
  const std::vector<bool> touches_sink = TouchSink();
  std::vector<Side> sides(source_, Side::kNeither);
  for (uint32_t node = 0; node < source_; ++node) {
    if (label_[node] != kUnreached) {
      sides[node] = Side::kSource;
    } else if (touches_sink[node]) {
      sides[node] = Side::kSink;
    }
  }
  return sides;
}

// By the node they leave, so that a node's arcs lie side by side.
void MinCut::Sort() {
  first_.assign(sink_ + 2, 0);
  for (const Edge& edge : edges_)
    for (uint32_t end : edge.ends) ++first_[end + 1];
  for (size_t u = 1; u < first_.size(); ++u) first_[u] += first_[u - 1];
  arcs_.resize(2 * edges_.size());
  std::vector<uint32_t> place(first_.begin(), first_.end() - 1);
  for (const auto& [ends, room] : edges_) {
    const uint32_t there = place[ends[0]]++, back = place[ends[1]]++;
    arcs_[there] = {ends[1], back, room[0]};
    arcs_[back] = {ends[0], there, room[1]};
  }
}

void MinCut::LabelAll() {
  lifts_ = 0;
  next_.assign(first_.begin(), first_.end() - 1);
  label_.assign(sink_ + 1, kUnreached);
  label_[source_] = 0;
  std::vector<uint32_t> queue = {source_};
  for (size_t i = 0; i < queue.size(); ++i) {
    const uint32_t u = queue[i];
    for (uint32_t k = first_[u]; k < first_[u + 1]; ++k) {
      const auto [from, back, room] = arcs_[k];
      if (label_[from] != kUnreached || arcs_[back].room <= least_room_)
        continue;
      label_[from] = label_[u] + 1;
      queue.push_back(from);
    }
  }
}

// A node that no more arcs lead down from waits for its next turn.
void MinCut::Discharge(uint32_t node) {
  if (label_[node] == kUnreached) return;
  for (uint32_t& k = next_[node]; k < first_[node + 1]; ++k) {
    const Arc& arc = arcs_[k];
    if (arc.room <= least_room_ || label_[arc.to] == kUnreached ||
        label_[node] != label_[arc.to] + 1)
      continue;
    Push(node, k);
    if (excess_[node] == 0) return;
  }
  Lift(node);
  active_.push_back(node);
}

void MinCut::Lift(uint32_t node) {
  ++lifts_;
  next_[node] = first_[node];
  uint32_t least = kUnreached;
  for (uint32_t k = first_[node]; k < first_[node + 1]; ++k)
    if (arcs_[k].room > least_room_)
      least = std::min(least, label_[arcs_[k].to]);
  // As far as there are nodes: it leads to the source no more.
  label_[node] = least < sink_ ? least + 1 : kUnreached;
}

void MinCut::Push(uint32_t node, uint32_t arc) {
  const double flow = std::min(excess_[node], arcs_[arc].room);
  const uint32_t to = arcs_[arc].to;
  if (excess_[to] == 0 && to != source_ && to != sink_) active_.push_back(to);
  excess_[node] -= flow;
  excess_[to] += flow;
  arcs_[arc].room -= flow;
  arcs_[arcs_[arc].back].room += flow;
}

// Whether the sink can be reached, full arcs or not.
std::vector<bool> MinCut::TouchSink() const {
  std::vector<bool> touches(sink_ + 1, false);
  touches[sink_] = true;
  std::vector<uint32_t> queue = {sink_};
  for (size_t i = 0; i < queue.size(); ++i)
    for (uint32_t k = first_[queue[i]]; k < first_[queue[i] + 1]; ++k) {
      const uint32_t v = arcs_[k].to;
      if (v == source_ || touches[v]) continue;
      touches[v] = true;
      queue.push_back(v);
    }
  return touches;
}

}  // namespace marrow
