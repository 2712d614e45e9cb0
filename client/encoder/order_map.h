// From the order in which a Draco payload decodes back to the order of the
// file it was made from.
#ifndef MARROW_CLIENT_ENCODER_ORDER_MAP_H_
#define MARROW_CLIENT_ENCODER_ORDER_MAP_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "client/polygon_mesh.h"

namespace marrow {

// How a payload came from a file. Vertices at one position (to the bit) are one
// site; the triangles of a polygon follow each other.
struct PayloadOrigin {
  std::vector<uint32_t> site_of_vertex;  // a file vertex -> its site
  // Triangles of face f are [triangle_begin[f], triangle_begin[f + 1]).
  std::vector<uint32_t> triangle_begin = {0};
  std::vector<std::array<uint32_t, 3>> triangles;  // file vertices
  std::vector<uint32_t> triangle_of_decoded_face;
  std::vector<uint32_t> site_of_decoded_point;
};

// Immutable and thread safe.
class OrderMap {
 public:
  OrderMap() = default;
  // Faces of the file that are not in the payload (no triangle, or dropped as
  // degenerate) are tied to a face that is: one that shares an edge with it,
  // else a vertex, else the nearest; of several the first.
  OrderMap(const PolygonMesh& mesh, const PayloadOrigin& origin);

  uint32_t NumDecodedFaces() const { return num_decoded_faces_; }
  uint32_t NumDecodedPoints() const {
    return static_cast<uint32_t>(vertex_of_point_.size());
  }

  // Vertices of the file that no face uses.
  uint32_t NumUnusedVertices() const;

  // A label a face of the file. A polygon has that of its largest triangle,
  // whatever the labels: so what is nested on triangles is on polygons.
  // INTERNAL unless there is a label a decoded face.
  absl::StatusOr<std::vector<uint32_t>> FaceLabelsInFileOrder(
      std::span<const uint32_t> decoded_face_labels) const;

  // A label a vertex of the file; kNone for one that no face uses. INTERNAL
  // unless there is a label a decoded point.
  absl::StatusOr<std::vector<uint32_t>> VertexLabelsInFileOrder(
      std::span<const uint32_t> decoded_point_labels) const;

  // The file's vertices at the given decoded points, ascending, each once: of
  // several at one position the first that a face uses. INTERNAL for a point
  // that does not exist.
  absl::StatusOr<std::vector<uint32_t>> FileVertices(
      std::span<const uint32_t> decoded_points) const;

 private:
  uint32_t num_decoded_faces_ = 0;
  std::vector<uint32_t> decoded_face_of_face_;  // its own or a stand-in's
  std::vector<uint32_t> point_of_vertex_;       // or kNone
  std::vector<uint32_t> vertex_of_point_;
};

}  // namespace marrow

#endif  // MARROW_CLIENT_ENCODER_ORDER_MAP_H_
