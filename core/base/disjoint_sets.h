// Union-find over 0 .. n-1. Not thread safe.
#ifndef MARROW_CORE_BASE_DISJOINT_SETS_H_
#define MARROW_CORE_BASE_DISJOINT_SETS_H_

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace marrow {

// The representative of a set is its least member, whatever the order of the
// unions, so results do not depend on that order.
class DisjointSets {
 public:
  explicit DisjointSets(uint32_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  uint32_t Find(uint32_t x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  // Whether they were apart.
  bool Union(uint32_t a, uint32_t b) {
    a = Find(a);
    b = Find(b);
    if (a == b) return false;
    if (b < a) std::swap(a, b);
    parent_[b] = a;
    return true;
  }

  // Of each member the representative of its set.
  std::vector<uint32_t> Representatives() {
    std::vector<uint32_t> all(parent_.size());
    for (uint32_t x = 0; x < all.size(); ++x) all[x] = Find(x);
    return all;
  }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace marrow

#endif  // MARROW_CORE_BASE_DISJOINT_SETS_H_
