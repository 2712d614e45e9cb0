#include "core/mesh/spots.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/base/cancellable.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

// The highest bit in which two finite numbers differ, written in binary: the
// power of two, but for a constant. The sign is above all bits.
int HighestDifference(double a, double b) {
  constexpr int kMantissa = 52;
  if (a == b) return std::numeric_limits<int>::min();
  if ((a < 0) != (b < 0)) return std::numeric_limits<int>::max();
  const auto x = std::bit_cast<uint64_t>(std::abs(a));
  const auto y = std::bit_cast<uint64_t>(std::abs(b));
  const auto exponent = static_cast<int>(std::max(x, y) >> kMantissa);
  if (x >> kMantissa != y >> kMantissa) return exponent;
  return std::max(exponent, 1) - kMantissa + std::bit_width(x ^ y) - 1;
}

bool IsBeforeOnCurve(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  int by = 0, highest = HighestDifference(a[0], b[0]);
  for (int i = 1; i < 3; ++i)
    if (const int bit = HighestDifference(a[i], b[i]); bit > highest) {
      by = i;
      highest = bit;
    }
  return a[by] < b[by];
}

}  // namespace

absl::StatusOr<Spots> Weld(const Positions& points, const CancelToken& cancel) {
  struct Record {
    Eigen::Vector3d place;
    uint32_t point;
  };
  std::vector<Record> records(points.rows());
  for (uint32_t p = 0; p < records.size(); ++p)
    // Adding 0 makes -0 into 0 and leaves everything else.
    records[p] = {points.row(p).transpose().array() + 0.0, p};
  const auto before = [](const Record& a, const Record& b) {
    return IsBeforeOnCurve(a.place, b.place);
  };
  MARROW_RETURN_IF_ERROR(
      SortUnlessCancelled(records.begin(), records.end(), before, cancel));
  Spots spots;
  spots.of_point.resize(records.size());
  spots.positions.resize(points.rows(), 3);
  uint32_t count = 0;
  MARROW_RETURN_IF_ERROR(ForEachIndex(records.size(), cancel, [&](size_t i) {
    const auto& [place, point] = records[i];
    if (i == 0 || place != records[i - 1].place)
      spots.positions.row(count++) = place.transpose();
    spots.of_point[point] = count - 1;
  }));
  spots.positions.conservativeResize(count, 3);
  return spots;
}

}  // namespace marrow
