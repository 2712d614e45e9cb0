// The nearest vertex of another body.
#ifndef MARROW_CORE_OPERATORS_BODY_TREE_H_
#define MARROW_CORE_OPERATORS_BODY_TREE_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"
#include "core/operators/bridges.h"

namespace marrow {

// Two points and how far apart they are; by distance, then by their numbers.
struct Candidate {
  double distance = std::numeric_limits<double>::infinity();  // squared
  Bridge ends{};

  bool IsBridge() const { return ends[0] != ends[1]; }
  friend bool operator<(const Candidate& a, const Candidate& b) {
    return std::tie(a.distance, a.ends) < std::tie(b.distance, b.ends);
  }
};

// A balanced k-d tree whose subtrees know when they are of one body, so that a
// body's search for its neighbours does not walk through the body itself: two
// large bodies far apart would cost the square of their size.
class BodyTree {
 public:
  // Not balanced, and slow to search, once cancelled.
  BodyTree(Positions points, const CancelToken& cancel)
      : points_(std::move(points)), order_(points_.rows()) {
    std::iota(order_.begin(), order_.end(), 0u);
    Build(0, static_cast<uint32_t>(order_.size()), cancel);
  }

  // `body` must outlive the searches.
  void SetBodies(const std::vector<uint32_t>& body) {
    body_ = &body;
    // Children stand behind their parents.
    for (size_t i = nodes_.size(); i-- > 0;)
      nodes_[i].body =
          nodes_[i].right == 0
              ? CommonBody(nodes_[i])
              : Common(nodes_[i + 1].body, nodes_[nodes_[i].right].body);
  }

  // Lowers `best` to the least bridge from the vertex to another body. Equal
  // distances are looked at too: the least pair of vertices wins.
  void Improve(uint32_t from, Candidate& best) const { Search(0, from, best); }

 private:
  static constexpr uint32_t kLeafSize = 8;

  struct Node {
    Eigen::RowVector3d low, high;
    uint32_t begin, end;       // in order_
    uint32_t right = 0;        // the left child is the next node; 0 for a leaf
    uint32_t body = kNoIndex;  // kNoIndex where there are several
  };

  uint32_t Build(uint32_t begin, uint32_t end, const CancelToken& cancel) {
    const uint32_t id = static_cast<uint32_t>(nodes_.size());
    Node node{points_.row(order_[begin]), points_.row(order_[begin]), begin,
              end};
    for (uint32_t i = begin; i < end; ++i) {
      node.low = node.low.cwiseMin(points_.row(order_[i]));
      node.high = node.high.cwiseMax(points_.row(order_[i]));
    }
    nodes_.push_back(node);
    if (end - begin <= kLeafSize || cancel.IsCancelled()) return id;
    int axis;
    (node.high - node.low).maxCoeff(&axis);
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle,
                     order_.begin() + end, [&](uint32_t a, uint32_t b) {
                       return points_(a, axis) < points_(b, axis);
                     });
    Build(begin, middle, cancel);
    const uint32_t right = Build(middle, end, cancel);
    nodes_[id].right = right;
    return id;
  }

  static uint32_t Common(uint32_t a, uint32_t b) {
    return a == b ? a : kNoIndex;
  }
  uint32_t CommonBody(const Node& leaf) const {
    uint32_t common = (*body_)[order_[leaf.begin]];
    for (uint32_t i = leaf.begin; i < leaf.end; ++i)
      common = Common(common, (*body_)[order_[i]]);
    return common;
  }

  // Both distances add up in one order, so rounding cannot put a point nearer
  // than its box.
  static double Square(const Eigen::RowVector3d& d) {
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  }
  double BoxDistance(const Node& node, uint32_t from) const {
    const Eigen::RowVector3d p = points_.row(from);
    return Square((node.low - p).cwiseMax(p - node.high).cwiseMax(0.0));
  }

  void Search(uint32_t id, uint32_t from, Candidate& best) const {
    const Node& node = nodes_[id];
    if (node.body == (*body_)[from] || BoxDistance(node, from) > best.distance)
      return;
    if (node.right == 0) {
      for (uint32_t i = node.begin; i < node.end; ++i)
        Consider(from, order_[i], best);
      return;
    }
    uint32_t near = id + 1, far = node.right;
    if (BoxDistance(nodes_[far], from) < BoxDistance(nodes_[near], from))
      std::swap(near, far);
    Search(near, from, best);
    Search(far, from, best);
  }

  void Consider(uint32_t from, uint32_t to, Candidate& best) const {
    if ((*body_)[to] == (*body_)[from]) return;
    const Eigen::RowVector3d apart = points_.row(to) - points_.row(from);
    best = std::min(best, Candidate{Square(apart),
                                    {std::min(from, to), std::max(from, to)}});
  }

  Positions points_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
  const std::vector<uint32_t>* body_ = nullptr;
};

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_BODY_TREE_H_
