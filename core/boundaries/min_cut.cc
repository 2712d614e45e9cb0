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
  AddArcs(a, b, cost, cost);
}

void MinCut::ConnectToSource(uint32_t node, double cost) {
  AddArcs(source_, node, cost, 0);
}

void MinCut::ConnectToSink(uint32_t node, double cost) {
  AddArcs(node, sink_, cost, 0);
}

void MinCut::AddArcs(uint32_t from, uint32_t to, double room,
                     double room_back) {
  assert(room >= 0 && room_back >= 0);
  arcs_.push_back({to, room});
  arcs_.push_back({from, room_back});
  least_room_ = std::max(least_room_, kRounding * room);
}

std::vector<MinCut::Side> MinCut::Solve() {
  Sort();
  while (FindLevels()) Augment();
  const std::vector<bool> touches_sink = TouchSink();
  std::vector<Side> sides(source_, Side::kNeither);
  for (uint32_t node = 0; node < source_; ++node) {
    if (level_[node] != kUnreached) {
      sides[node] = Side::kSource;
    } else if (touches_sink[node]) {
      sides[node] = Side::kSink;
    }
  }
  return sides;
}

void MinCut::Sort() {
  first_.assign(sink_ + 2, 0);
  for (uint32_t i = 0; i < arcs_.size(); ++i) ++first_[arcs_[i ^ 1].to + 1];
  for (size_t u = 1; u < first_.size(); ++u) first_[u] += first_[u - 1];
  out_.resize(arcs_.size());
  std::vector<uint32_t> place(first_.begin(), first_.end() - 1);
  for (uint32_t i = 0; i < arcs_.size(); ++i)
    out_[place[arcs_[i ^ 1].to]++] = i;
}

// Steps from the source over arcs with room; whether the sink is among them.
bool MinCut::FindLevels() {
  level_.assign(sink_ + 1, kUnreached);
  level_[source_] = 0;
  std::vector<uint32_t> queue = {source_};
  for (size_t i = 0; i < queue.size(); ++i) {
    const uint32_t u = queue[i];
    for (uint32_t k = first_[u]; k < first_[u + 1]; ++k) {
      const Arc& arc = arcs_[out_[k]];
      if (arc.room <= least_room_ || level_[arc.to] != kUnreached) continue;
      level_[arc.to] = level_[u] + 1;
      queue.push_back(arc.to);
    }
  }
  return level_[sink_] != kUnreached;
}

// Fills all shortest paths.
void MinCut::Augment() {
  next_.assign(first_.begin(), first_.end() - 1);
  std::vector<uint32_t> path;
  for (;;) {
    const uint32_t u = path.empty() ? source_ : arcs_[path.back()].to;
    if (u == sink_) {
      Push(path);
      continue;
    }
    while (next_[u] < first_[u + 1]) {
      const Arc& arc = arcs_[out_[next_[u]]];
      if (arc.room > least_room_ && level_[arc.to] == level_[u] + 1) break;
      ++next_[u];
    }
    if (next_[u] < first_[u + 1]) {
      path.push_back(out_[next_[u]]);
    } else if (path.empty()) {
      return;
    } else {
      ++next_[arcs_[path.back() ^ 1].to];
      path.pop_back();
    }
  }
}

// Fills the path, and leaves what stands before its first full arc.
void MinCut::Push(std::vector<uint32_t>& path) {
  double flow = std::numeric_limits<double>::max();
  for (uint32_t i : path) flow = std::min(flow, arcs_[i].room);
  size_t full = path.size();
  for (size_t i = path.size(); i-- > 0;) {
    arcs_[path[i]].room -= flow;
    arcs_[path[i] ^ 1].room += flow;
    if (arcs_[path[i]].room <= least_room_) full = i;
  }
  path.resize(full);
}

// Whether the sink can be reached, full arcs or not.
std::vector<bool> MinCut::TouchSink() const {
  std::vector<bool> touches(sink_ + 1, false);
  touches[sink_] = true;
  std::vector<uint32_t> queue = {sink_};
  for (size_t i = 0; i < queue.size(); ++i)
    for (uint32_t k = first_[queue[i]]; k < first_[queue[i] + 1]; ++k) {
      const uint32_t v = arcs_[out_[k]].to;
      if (v == source_ || touches[v]) continue;
      touches[v] = true;
      queue.push_back(v);
    }
  return touches;
}

}  // namespace marrow
