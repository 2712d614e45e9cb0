// Meshes that the exporters' tests share.
#ifndef MARROW_TESTS_CLIENT_EXPORTERS_MESHES_H_
#define MARROW_TESTS_CLIENT_EXPORTERS_MESHES_H_

#include <cstdint>
#include <vector>

#include "client/polygon_mesh.h"

namespace marrow {

struct LabelledMesh {
  PolygonMesh mesh;
  std::vector<uint32_t> labels;
};

// A row of quads, triangles and a pentagon over seven vertices in use:
//
//   4---5---6      faces 0 (quad 0 1 5 4) and 3 (triangle 3 2 6): label 7
//   |   | / |\     faces 1 (triangle 1 2 6), 2 (triangle 1 6 5): label 2
//   0---1---2-3
//
// Face 4 has two corners, vertex 7 is used by no face. Coordinates are such
// that few digits do not hold them.
inline LabelledMesh MakeStrip() {
  LabelledMesh strip;
  strip.mesh.positions = {
      {0.1f, 0, 0},           {1.0f / 3, 0, 0}, {2, 1e-20f, 0},
      {3, 0, 16777215.0f},    {0, 1, 0},        {1, 1, 1.1754944e-38f},
      {2, 1, -3.4028235e38f}, {9, 9, 9}};
  strip.mesh.AddFace(std::vector<uint32_t>{0, 1, 5, 4});
  strip.mesh.AddFace(std::vector<uint32_t>{1, 2, 6});
  strip.mesh.AddFace(std::vector<uint32_t>{1, 6, 5});
  strip.mesh.AddFace(std::vector<uint32_t>{3, 2, 6});
  strip.mesh.AddFace(std::vector<uint32_t>{0, 1});
  strip.labels = {7, 2, 2, 7, 2};
  return strip;
}

// One face of `corners` corners on a circle.
inline LabelledMesh MakePolygon(uint32_t corners) {
  LabelledMesh polygon;
  std::vector<uint32_t> face;
  for (uint32_t v = 0; v < corners; ++v) {
    polygon.mesh.positions.push_back({static_cast<float>(v), 1, 2});
    face.push_back(v);
  }
  polygon.mesh.AddFace(face);
  polygon.labels = {0};
  return polygon;
}

}  // namespace marrow

#endif  // MARROW_TESTS_CLIENT_EXPORTERS_MESHES_H_
