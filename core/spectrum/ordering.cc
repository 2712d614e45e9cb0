// Why not METIS: it orders a million vertices in 7 seconds, on one thread, with
// the process's rand(), and cannot be cancelled. A surface has positions, and a
// plane through it cuts it in short curves; where it folds, distance in the
// graph cuts it shorter. Both are tried where it matters, on the large sets.
#include "core/spectrum/ordering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <thread>

namespace marrow {
namespace {

// Sets up to this size are not cut.
constexpr int kLeaf = 8;
// Sets from this size on are cut in every way tried, smaller ones across their
// longest side only.
constexpr int kChoose = 400;
// Cuts are sought between these shares of a set, at one of kBins places.
constexpr double kLeastShare = 0.36;
constexpr int kBins = 256;

class Dissection {
 public:
  Dissection(const Graph& graph, const double* positions,
             const CancelToken& cancel)
      : graph_(graph),
        positions_(positions),
        cancel_(cancel),
        part_(graph.NumVertices(), 0),
        key_(graph.NumVertices(), 0) {}

  // Orders `set` in place. Different threads may order sets that have no edge
  // between them.
  void Order(int* begin, int* end, int threads) {
    const int size = static_cast<int>(end - begin);
    if (size <= kLeaf || cancel_.IsCancelled()) return;
    int* middle;
    int* separator;
    if (!Cut(begin, end, middle, separator)) return;
    if (threads > 1 && size > kParallel) {
      std::thread other([=, this] { Order(begin, middle, threads / 2); });
      Order(middle, separator, threads - threads / 2);
      other.join();
    } else {
      Order(begin, middle, 1);
      Order(middle, separator, 1);
    }
  }

  // Vertices that no set may hold, such as those with too many neighbours.
  void Exclude(int v) { part_[v] = kOutside; }

 private:
  static constexpr uint8_t kOutside = 255;
  static constexpr int kParallel = 20'000;
  // Parts of the set that is being cut; a vertex of no set at work is 0.
  static constexpr uint8_t kLow = 1, kHigh = 2, kCut = 3;

  template <typename Visit>
  void ForNeighbours(int v, Visit visit) const {
    for (int e = graph_.start[v]; e < graph_.start[v + 1]; ++e)
      visit(graph_.neighbours[e]);
  }

  double At(int v, int axis) const { return positions_[3L * v + axis]; }

  // Reorders the set as low half, high half, separator. False where every
  // vertex would be in the separator or in one half, or once cancelled.
  bool Cut(int* begin, int* end, int*& middle, int*& separator) {
    const int size = static_cast<int>(end - begin);
    const std::array<int, 3> axes = AxesByExtent(begin, end);
    if (size < kChoose) {
      SetKeysToAxis(begin, end, axes[0]);
      SplitAtMedian(begin, end);
    } else {
      SplitBest(begin, end, axes);
      if (cancel_.IsCancelled()) return false;
    }
    MoveToSeparator(begin, end);
    return Arrange(begin, end, middle, separator);
  }

  std::array<int, 3> AxesByExtent(const int* begin, const int* end) const {
    std::array<double, 3> low, high, extent;
    low.fill(HUGE_VAL);
    high.fill(-HUGE_VAL);
    for (const int* v = begin; v < end; ++v)
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], At(*v, axis));
        high[axis] = std::max(high[axis], At(*v, axis));
      }
    for (int axis = 0; axis < 3; ++axis) extent[axis] = high[axis] - low[axis];
    std::array<int, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(),
                     [&](int a, int b) { return extent[a] > extent[b]; });
    return axes;
  }

  void SetKeysToAxis(const int* begin, const int* end, int axis) {
    for (const int* v = begin; v < end; ++v) key_[*v] = At(*v, axis);
  }

  // Keys count the edges to a vertex at the rim of the set; a component not
  // reached follows the others.
  void SetKeysToDistance(const int* begin, const int* end) {
    std::vector<int> order;
    order.reserve(end - begin);
    Search(begin, end, *begin, order);
    // From the farthest vertex: the rim.
    const int rim = order.back();
    Search(begin, end, rim, order);
  }

  void Search(const int* begin, const int* end, int root,
              std::vector<int>& order) {
    for (const int* v = begin; v < end; ++v) part_[*v] = kLow;
    order.clear();
    double base = 0;
    const int* next_root = begin;
    for (int at = root;;) {
      key_[at] = base;
      part_[at] = kHigh;
      size_t read = order.size();
      order.push_back(at);
      for (; read < order.size(); ++read) {
        const int v = order[read];
        ForNeighbours(v, [&](int u) {
          if (part_[u] != kLow) return;
          part_[u] = kHigh;
          key_[u] = key_[v] + 1;
          order.push_back(u);
        });
      }
      while (next_root < end && part_[*next_root] != kLow) ++next_root;
      if (next_root == end) break;
      at = *next_root;
      base = key_[order.back()] + 1;
    }
    for (const int* v = begin; v < end; ++v) part_[*v] = 0;
  }

  void SplitAtMedian(int* begin, int* end) {
    int* median = begin + (end - begin) / 2;
    std::nth_element(begin, median, end, [&](int a, int b) {
      return key_[a] != key_[b] ? key_[a] < key_[b] : a < b;
    });
    for (int* v = begin; v < median; ++v) part_[*v] = kLow;
    for (int* v = median; v < end; ++v) part_[*v] = kHigh;
  }

  // Where a key may be cut with the fewest edges across, and how many.
  struct Choice {
    double threshold;
    double cost;
  };

  // Counts, for every bin, the vertices below it and the edges over it.
  Choice BestThreshold(const int* begin, const int* end) const {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const int* v = begin; v < end; ++v) {
      low = std::min(low, key_[*v]);
      high = std::max(high, key_[*v]);
    }
    const int size = static_cast<int>(end - begin);
    if (!(high > low)) return {low, 4.0 * size};
    const double scale = kBins / (high - low);
    const auto bin = [&](int v) {
      return std::min(kBins - 1, static_cast<int>((key_[v] - low) * scale));
    };
    std::array<int, kBins + 1> below{}, across{};
    for (const int* v = begin; v < end; ++v) {
      const int b = bin(*v);
      ++below[b + 1];
      ForNeighbours(*v, [&](int u) {
        if (part_[u] != kLow) return;
        const int other = bin(u);
        if (other <= b) return;
        ++across[b + 1];
        --across[other + 1 > kBins ? kBins : other + 1];
      });
    }
    return Cheapest(below, across, size, low, 1 / scale);
  }

  static Choice Cheapest(const std::array<int, kBins + 1>& below,
                         const std::array<int, kBins + 1>& across, int size,
                         double low, double width) {
    Choice best{low, HUGE_VAL};
    int vertices = 0, edges = 0;
    for (int b = 1; b < kBins; ++b) {
      vertices += below[b];
      edges += across[b];
      const double share = static_cast<double>(vertices) / size;
      const double imbalance = std::abs(share - 0.5);
      if (imbalance > 0.5 - kLeastShare) continue;
      const double cost = edges * (1 + 2 * imbalance);
      if (cost < best.cost) best = {low + b * width, cost};
    }
    return best;
  }

  void SplitBest(int* begin, int* end, const std::array<int, 3>& axes) {
    // An axis is 0 to 2, the distance 3.
    int best_way = -1;
    Choice best{0, HUGE_VAL};
    for (int way : {axes[0], axes[1], axes[2], 3}) {
      if (cancel_.IsCancelled()) break;
      SetKeys(begin, end, way);
      for (int* v = begin; v < end; ++v) part_[*v] = kLow;
      const Choice choice = BestThreshold(begin, end);
      for (int* v = begin; v < end; ++v) part_[*v] = 0;
      if (choice.cost < best.cost) {
        best = choice;
        best_way = way;
      }
    }
    if (best_way < 0) {
      SetKeysToAxis(begin, end, axes[0]);
      return SplitAtMedian(begin, end);
    }
    if (best_way != 3) SetKeys(begin, end, best_way);
    for (int* v = begin; v < end; ++v)
      part_[*v] = key_[*v] < best.threshold ? kLow : kHigh;
  }

  void SetKeys(const int* begin, const int* end, int way) {
    if (way < 3) {
      SetKeysToAxis(begin, end, way);
    } else {
      SetKeysToDistance(begin, end);
    }
  }

  // The vertices of one part that have a neighbour in the other become the
  // separator: of the two rims the smaller.
  void MoveToSeparator(const int* begin, const int* end) {
    int rim[3] = {0, 0, 0};
    for (const int* v = begin; v < end; ++v)
      if (OnRim(*v)) ++rim[part_[*v]];
    const uint8_t from = rim[kLow] <= rim[kHigh] ? kLow : kHigh;
    // In this order, a rim vertex whose neighbours across are all cut already
    // does not exist: only `from` vertices move.
    std::vector<int> moved;
    for (const int* v = begin; v < end; ++v)
      if (part_[*v] == from && OnRim(*v)) moved.push_back(*v);
    for (int v : moved) part_[v] = kCut;
  }

  bool OnRim(int v) const {
    const uint8_t other = part_[v] == kLow ? kHigh : kLow;
    for (int e = graph_.start[v]; e < graph_.start[v + 1]; ++e)
      if (part_[graph_.neighbours[e]] == other) return true;
    return false;
  }

  bool Arrange(int* begin, int* end, int*& middle, int*& separator) {
    const int size = static_cast<int>(end - begin);
    middle = std::stable_partition(begin, end,
                                   [&](int v) { return part_[v] == kLow; });
    separator = std::stable_partition(middle, end,
                                      [&](int v) { return part_[v] == kHigh; });
    for (int* v = begin; v < end; ++v) part_[*v] = 0;
    return middle - begin < size && separator - middle < size &&
           separator > begin;
  }

  const Graph& graph_;
  const double* positions_;
  const CancelToken& cancel_;
  std::vector<uint8_t> part_;
  std::vector<double> key_;
};

}  // namespace

absl::StatusOr<std::vector<int>> DissectionOrder(const Graph& graph,
                                                 const double* positions,
                                                 int threads,
                                                 const CancelToken& cancel) {
  const int n = graph.NumVertices();
  Dissection dissection(graph, positions, cancel);
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  // A hub would be in every separator: it is one for all.
  const double hub = std::max(64.0, 10 * std::sqrt(n));
  const auto hubs = std::stable_partition(
      order.begin(), order.end(),
      [&](int v) { return graph.start[v + 1] - graph.start[v] <= hub; });
  for (auto v = hubs; v != order.end(); ++v) dissection.Exclude(*v);
  dissection.Order(order.data(), order.data() + (hubs - order.begin()),
                   threads);
  if (absl::Status status = cancel.Check(); !status.ok()) return status;
  return order;
}

}  // namespace marrow
