// Sums of the areas of faces.
#ifndef MARROW_CORE_MESH_FACE_AREAS_H_
#define MARROW_CORE_MESH_FACE_AREAS_H_

#include <cstdint>
#include <vector>

namespace marrow {

// Of some faces, in the unit of `face_areas`.
inline double AreaOf(const std::vector<uint32_t>& faces,
                     const std::vector<double>& face_areas) {
  double sum = 0;
  for (uint32_t f : faces) sum += face_areas[f];
  return sum;
}

}  // namespace marrow

#endif  // MARROW_CORE_MESH_FACE_AREAS_H_
