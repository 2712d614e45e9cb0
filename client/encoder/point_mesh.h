// A polygon mesh as Draco takes it: triangles over points, where a point is a
// site with what a corner carries there.
#ifndef MARROW_CLIENT_ENCODER_POINT_MESH_H_
#define MARROW_CLIENT_ENCODER_POINT_MESH_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/polygon_mesh.h"

namespace marrow {

using Corners = std::array<uint32_t, 3>;

// Rows of numbers with equal ones (to the bit) put together, in order of first
// appearance.
template <typename T, size_t N>
struct DistinctRows {
  std::vector<std::array<T, N>> rows;
  std::vector<uint32_t> index;  // an input row -> its place in `rows`
};

// Triangles with the places of their corners in face_vertices, so that what a
// corner carries is found again.
struct CornerTriangles {
  std::vector<uint32_t> begin = {0};  // by face
  std::vector<Corners> corners;
};

struct PointMesh {
  // Of the file's vertices. Only sites of triangles have a row: an index beyond
  // is of a place where no triangle has a corner.
  DistinctRows<double, 3> sites;
  DistinctRows<float, 2> uvs;  // of corners; empty where not sent
  DistinctRows<float, 3> normals;
  std::vector<Corners> faces;         // points
  std::vector<Corners> site_corners;  // sites, parallel to faces
  std::vector<uint32_t> point_site;
  std::vector<uint32_t> point_uv;
  std::vector<uint32_t> point_normal;
};

// Triangles of every face, in the order of faces; a face with fewer than three
// corners has none. Deterministic.
CornerTriangles TriangulateAll(const PolygonMesh& mesh);

// Points are numbered in an order that the file alone decides. Vertices that no
// triangle has are left out: Draco decodes three points a face at most, and
// they may be anywhere, not finite or so far away that quantizing would leave
// the others no digits.
PointMesh BuildPointMesh(const PolygonMesh& mesh,
                         const CornerTriangles& triangles,
                         bool keep_attributes);

// Whether edgebreaker keeps every triangle, and is quick.
bool SuitsEdgebreaker(const PointMesh& mesh);

}  // namespace marrow

#endif  // MARROW_CLIENT_ENCODER_POINT_MESH_H_
