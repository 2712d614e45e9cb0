// A set of faces of the mesh with numbering and neighbourhoods of its own, so
// that work on it costs what the region weighs, not what the mesh does.
#ifndef MARROW_CORE_PIECES_REGION_H_
#define MARROW_CORE_PIECES_REGION_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/diffusion/diffusion_map.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pieces/face_links.h"
#include "core/pieces/ranked_set.h"

namespace marrow {

// "Local" is an index into faces, vertices or rows of Phi. Local order is the
// mesh's order, so ties broken by local id are broken by canonical id.
class Region {
 public:
  // `faces` ascending; areas are shares of the mesh's area. Of the links, those
  // with both ends in the region count.
  Region(const TriangleMesh& mesh, const Adjacency& adjacency,
         const std::vector<double>& face_areas,
         const std::vector<uint32_t>& faces, const FaceLinks& links = {});

  uint32_t NumFaces() const { return local_.NumFaces(); }
  uint32_t NumVertices() const {
    return static_cast<uint32_t>(vertices_.size());
  }
  uint32_t MeshFace(uint32_t f) const { return faces_[f]; }
  const std::vector<uint32_t>& mesh_vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<double>& areas() const { return areas_; }
  double area() const { return area_; }
  const Adjacency& adjacency() const { return local_; }
  // The face across each edge of f; kNoIndex where there is none, and where
  // there are several, which adjacency() knows.
  const std::array<uint32_t, 3>& Across(uint32_t f) const { return across_[f]; }

  // Pairs of local faces of different shells that count as neighbours, both
  // ways, ascending.
  const std::vector<std::array<uint32_t, 2>>& links() const { return links_; }
  // The local faces linked to f, as the second entries of pairs.
  std::span<const std::array<uint32_t, 2>> LinksOf(uint32_t f) const;

  // The local vertices of the boundary loop that v lies on, ascending; v alone
  // where it lies on none. The boundary is where the region meets the rest of
  // the mesh, not where the mesh ends.
  std::vector<uint32_t> BoundaryLoop(uint32_t v) const;

  // All local faces, ascending.
  std::vector<uint32_t> AllFaces() const;

 private:
  Region(const TriangleMesh& mesh, const Adjacency& adjacency,
         const std::vector<double>& face_areas,
         const std::vector<uint32_t>& faces, const FaceLinks& links,
         const RankedSet& vertices);

  std::vector<uint32_t> faces_;
  std::vector<uint32_t> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<double> areas_;
  double area_ = 0;
  Adjacency local_;
  std::vector<std::array<uint32_t, 3>> across_;
  std::vector<std::array<uint32_t, 2>> links_;
  // Local vertex -> its loop's least vertex; kNoIndex off the boundary.
  std::vector<uint32_t> loop_;
};

// Face -> number of its connected piece among faces of equal label. Faces are
// connected through edges and links. Pieces are numbered by their least face.
// Linear in the size of the mesh but for sorting at edges of many faces.
std::vector<uint32_t> ConnectedPieces(
    const Adjacency& adjacency, const std::vector<uint32_t>& labels,
    std::span<const std::array<uint32_t, 2>> links = {});

}  // namespace marrow

#endif  // MARROW_CORE_PIECES_REGION_H_
