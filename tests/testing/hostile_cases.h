// What the files of hostile_meshes.h share.
#ifndef MARROW_TESTS_TESTING_HOSTILE_CASES_H_
#define MARROW_TESTS_TESTING_HOSTILE_CASES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "tests/testing/hostile_meshes.h"

namespace marrow {

// A mesh, a vertex and a face at a time.
class Builder {
 public:
  uint32_t Add(double x, double y, double z) {
    points_.push_back({x, y, z});
    return static_cast<uint32_t>(points_.size() - 1);
  }
  void Face(uint32_t a, uint32_t b, uint32_t c) { faces_.push_back({a, b, c}); }
  void Square(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    Face(a, b, c);
    Face(a, c, d);
  }
  TriangleMesh Build() const {
    TriangleMesh mesh;
    mesh.positions.resize(points_.size(), 3);
    for (size_t v = 0; v < points_.size(); ++v)
      mesh.positions.row(v) << points_[v][0], points_[v][1], points_[v][2];
    mesh.faces = faces_;
    return mesh;
  }

 private:
  std::vector<std::array<double, 3>> points_;
  std::vector<Triangle> faces_;
};

using Cases = std::vector<HostileMesh>;

void AddTopology(bool full, Cases& cases);  // 74 to 78
void AddSpectra(bool full, Cases& cases);   // 79 to 82

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_HOSTILE_CASES_H_
