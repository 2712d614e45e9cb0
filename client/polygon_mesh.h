// A mesh as the user's file has it: polygons, in the file's own order.
//
// What the readers of client/mesh_file return and what the encoder, the
// exporters and the pictures take. Nothing here is welded, triangulated or
// repaired: face f of this mesh is face f of the file, so a label for face f
// can be written back beside it.
#ifndef MARROW_CLIENT_POLYGON_MESH_H_
#define MARROW_CLIENT_POLYGON_MESH_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace marrow {

struct PolygonMesh {
  // Vertex positions in the file's units. All are floats, unless the file holds
  // one that is not. May hold NaN or infinities where the file does: judging
  // them is the server's business.
  std::vector<std::array<double, 3>> positions;

  // Face f has the corners face_vertices[face_offsets[f] .. face_offsets[f+1]).
  // face_offsets has one entry more than there are faces and begins with 0.
  // Readers guarantee every vertex index < positions.size(). A face may have
  // fewer than three corners where the file has such a face.
  std::vector<uint32_t> face_offsets = {0};
  std::vector<uint32_t> face_vertices;

  // Texture coordinates a corner (parallel to face_vertices), or empty.
  std::vector<std::array<float, 2>> corner_uvs;
  // Normals a corner (parallel to face_vertices), or empty.
  std::vector<std::array<float, 3>> corner_normals;

  size_t NumVertices() const { return positions.size(); }
  size_t NumFaces() const { return face_offsets.size() - 1; }
  std::span<const uint32_t> Face(size_t f) const {
    return std::span<const uint32_t>(face_vertices)
        .subspan(face_offsets[f], face_offsets[f + 1] - face_offsets[f]);
  }
  void AddFace(std::span<const uint32_t> corners) {
    face_vertices.insert(face_vertices.end(), corners.begin(), corners.end());
    face_offsets.push_back(static_cast<uint32_t>(face_vertices.size()));
  }
};

// Whether a float holds x; what is not finite, it does.
inline bool IsFloat(double x) {
  if (!std::isfinite(x)) return true;
  return std::abs(x) <= std::numeric_limits<float>::max() &&
         static_cast<double>(static_cast<float>(x)) == x;
}

inline bool AreFloats(const std::vector<std::array<double, 3>>& positions) {
  return std::all_of(positions.begin(), positions.end(), [](const auto& p) {
    return IsFloat(p[0]) && IsFloat(p[1]) && IsFloat(p[2]);
  });
}

// The nearest float, an infinity for what is beyond all.
inline float ToFloat(double x) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // Half a step beyond the largest float: from there on, infinity is nearer.
  constexpr double kBeyond = 0x1.ffffffp127;
  if (std::abs(x) >= kBeyond) return x > 0 ? kInfinity : -kInfinity;
  return static_cast<float>(x);
}

}  // namespace marrow

#endif  // MARROW_CLIENT_POLYGON_MESH_H_
