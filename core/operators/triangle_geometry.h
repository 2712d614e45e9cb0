// A triangle from the lengths of its sides alone, as accurate as the lengths
// allow: for needles and caps too, given that the lengths are exact. `T` is
// double or long double.
#ifndef MARROW_CORE_OPERATORS_TRIANGLE_GEOMETRY_H_
#define MARROW_CORE_OPERATORS_TRIANGLE_GEOMETRY_H_

#include <algorithm>
#include <cmath>

namespace marrow {

// Area, by Heron's formula in Kahan's order ("Miscalculating Area and Angles of
// a Needle-like Triangle", 2014). 0 where no triangle has these sides.
template <typename T>
T TriangleArea(T a, T b, T c) {
  if (a < b) std::swap(a, b);
  if (b < c) std::swap(b, c);
  if (a < b) std::swap(a, b);
  const T product =
      (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return std::sqrt(std::max(T(0), product)) / 4;
}

// How far the sides are from lying on a line: the two shorter less the longest.
template <typename T>
T TriangleSlack(T a, T b, T c) {
  if (a < b) std::swap(a, b);
  if (a < c) std::swap(a, c);
  return b < c ? b - (a - c) : c - (a - b);
}

// b^2 + c^2 - a^2: four times the area times the cotangent of the angle
// opposite to side a.
template <typename T>
T ScaledCotangent(T a, T b, T c) {
  if (b < c) std::swap(b, c);
  return c * c + (b - a) * (b + a);
}

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_TRIANGLE_GEOMETRY_H_
