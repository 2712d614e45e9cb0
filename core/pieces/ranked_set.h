// A set of numbers that knows the place of each of its members among them all.
#ifndef MARROW_CORE_PIECES_RANKED_SET_H_
#define MARROW_CORE_PIECES_RANKED_SET_H_

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace marrow {

// The corners of some faces: bits from the least corner to the greatest, so
// that neither sorting nor searching is needed. Takes 12 bytes for 64 numbers
// of that range. Immutable, thread safe.
class RankedSet {
 public:
  // The corners of triangles[f] for all f of `members`.
  RankedSet(std::span<const Triangle> triangles,
            std::span<const uint32_t> members) {
    if (members.empty()) return;
    uint32_t least = kNoIndex, greatest = 0;
    for (uint32_t f : members) {
      const auto [low, high] = std::ranges::minmax(triangles[f]);
      least = std::min(least, low);
      greatest = std::max(greatest, high);
    }
    first_word_ = least / 64;
    words_.resize(greatest / 64 - first_word_ + 1);
    for (uint32_t f : members)
      for (uint32_t v : triangles[f])
        words_[v / 64 - first_word_] |= uint64_t{1} << (v % 64);
    before_.reserve(words_.size());
    for (uint64_t word : words_) {
      before_.push_back(size_);
      size_ += std::popcount(word);
    }
  }

  // How many members are less than v. REQUIRES: v is a member.
  uint32_t RankOf(uint32_t v) const {
    const uint32_t word = v / 64 - first_word_;
    const uint64_t below = (uint64_t{1} << (v % 64)) - 1;
    return before_[word] + std::popcount(words_[word] & below);
  }

  // Ascending.
  std::vector<uint32_t> Members() const {
    std::vector<uint32_t> members;
    members.reserve(size_);
    for (uint32_t w = 0; w < words_.size(); ++w)
      for (uint64_t rest = words_[w]; rest != 0; rest &= rest - 1)
        members.push_back(64 * (first_word_ + w) + std::countr_zero(rest));
    return members;
  }

 private:
  uint32_t first_word_ = 0;
  uint32_t size_ = 0;
  std::vector<uint64_t> words_;
  std::vector<uint32_t> before_;  // members in earlier words
};

}  // namespace marrow

#endif  // MARROW_CORE_PIECES_RANKED_SET_H_
