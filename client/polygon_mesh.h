// A mesh as the user's file has it: polygons, in the file's own order.
//
// What the readers of client/mesh_file return and what the encoder, the
// exporters and the pictures take. Nothing here is welded, triangulated or
// repaired: face f of this mesh is face f of the file, so a label for face f
// can be written back beside it.
#ifndef MARROW_CLIENT_POLYGON_MESH_H_
#define MARROW_CLIENT_POLYGON_MESH_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace marrow {

struct PolygonMesh {
  // Vertex positions in the file's units. May hold NaN or infinities where
  // the file does: judging them is the server's business.
  std::vector<std::array<float, 3>> positions;

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

}  // namespace marrow

#endif  // MARROW_CLIENT_POLYGON_MESH_H_
