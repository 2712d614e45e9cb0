// Loops and sorts that stop soon after they are cancelled.
#ifndef MARROW_CORE_BASE_CANCELLABLE_H_
#define MARROW_CORE_BASE_CANCELLABLE_H_

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/base/status_macros.h"

namespace marrow {

// Calls visit(i) for i of 0 .. count-1, ascending, and asks the token every
// 32,768 times. Errors: CANCELLED, with the rest not visited.
template <typename Visit>
absl::Status ForEachIndex(size_t count, const CancelToken& cancel,
                          const Visit& visit) {
  constexpr size_t kStride = size_t{1} << 15;
  for (size_t first = 0; first < count; first += kStride) {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    const size_t end = std::min(count, first + kStride);
    for (size_t i = first; i < end; ++i) visit(i);
  }
  return absl::OkStatus();
}

// std::sort that asks the token before every pass over a part, the first of
// which is over all. `before` is copied. Errors:
// CANCELLED, with the elements in any order.
template <typename Iterator, typename Before>
absl::Status SortUnlessCancelled(Iterator begin, Iterator end,
                                 const Before& before,
                                 const CancelToken& cancel) {
  constexpr std::ptrdiff_t kPart = std::ptrdiff_t{1} << 15;
  while (end - begin > kPart) {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    // A median of nine is seldom far from the middle.
    typename std::iterator_traits<Iterator>::value_type sample[9];
    for (std::ptrdiff_t i = 0; i < 9; ++i)
      sample[i] = begin[(end - begin - 1) * i / 8];
    std::nth_element(sample, sample + 4, sample + 9, before);
    auto middle = std::partition(
        begin, end, [&](const auto& x) { return before(x, sample[4]); });
    if (std::min(middle - begin, end - middle) < (end - begin) / 16) {
      middle = begin + (end - begin) / 2;
      std::nth_element(begin, middle, end, before);
    }
    MARROW_RETURN_IF_ERROR(SortUnlessCancelled(begin, middle, before, cancel));
    begin = middle;
  }
  MARROW_RETURN_IF_ERROR(cancel.Check());
  std::sort(begin, end, before);
  return absl::OkStatus();
}

}  // namespace marrow

#endif  // MARROW_CORE_BASE_CANCELLABLE_H_
