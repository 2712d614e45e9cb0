// Work on pairs of pieces, at once where they have no piece in common.
#ifndef MARROW_CORE_BOUNDARIES_PAIR_ORDER_H_
#define MARROW_CORE_BOUNDARIES_PAIR_ORDER_H_

#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include "core/spectrum/team.h"

namespace marrow {

using PiecePair = std::pair<uint32_t, uint32_t>;

// Calls body(worker, pair) for every pair on the threads of the team; `worker`
// is less than their number, and no two calls have it at a time. Of two pairs
// that have a piece in common the earlier one has returned before the later one
// begins: where a body changes nothing but its pair's two pieces, and nothing
// else that it sees depends on who is faster, all is as if one pair came after
// the other.
void ForPairs(Team& team, std::span<const PiecePair> pairs,
              const std::function<void(int, const PiecePair&)>& body);

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_PAIR_ORDER_H_
