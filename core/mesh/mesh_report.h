// What there is to say about a mesh before anything is computed on it.
#ifndef MARROW_CORE_MESH_MESH_REPORT_H_
#define MARROW_CORE_MESH_MESH_REPORT_H_

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// Counts are exact. "Decoded" is the payload as it came, the rest describes
// the welded mesh. Lengths and areas are in the payload's units.
struct MeshReport {
  uint64_t decoded_points = 0;
  uint64_t decoded_faces = 0;
  uint64_t vertices = 0;  // after welding, used by a kept face
  // Neither degenerate nor duplicate nor inner walls; split.
  uint64_t faces = 0;
  uint64_t welded_points = 0;  // points less different positions
  uint64_t crack_points = 0;   // vertices at cracks, made one with others
  uint64_t t_junctions = 0;    // vertices inside edges, which are split there
  uint64_t unused_points = 0;  // points that no decoded face uses
  uint64_t degenerate_faces = 0;  // two corners at one position; dropped
  uint64_t duplicate_faces = 0;   // same three vertices as another; dropped
  uint64_t inner_wall_faces = 0;  // of either side; dropped
  uint64_t zero_area_faces = 0;   // kept, three corners exactly on a line
  uint64_t sliver_faces = 0;      // kept, with an angle under one degree
  // Faces to turn over, at the least, for neighbours to agree; one-sided parts
  // of the mesh (a Moebius strip) are left out and make it not orientable.
  uint64_t flipped_faces = 0;
  bool orientable = true;
  uint64_t components = 0;         // connected through shared vertices
  uint64_t boundary_edges = 0;     // in exactly one kept face
  uint64_t boundary_loops = 0;     // connected components of boundary edges
  uint64_t nonmanifold_edges = 0;  // in three or more kept faces
  // Whose faces, joined across the edges that meet there, are two or more
  // groups: two cones that touch at their tips.
  uint64_t nonmanifold_vertices = 0;
  // Vertices - edges + faces.
  int64_t euler_characteristic = 0;
  // Handles of all components together; nothing where the mesh is not a closed,
  // orientable surface.
  std::optional<uint64_t> genus;
  // What core/operators/bodies.h makes of the components; 0 before it has.
  uint64_t bodies = 0;               // computed on by themselves
  uint64_t bridged_components = 0;   // joined with others to one body
  uint64_t bridges = 0;              // pairs of vertices that join them
  double bridging_distance = 0;      // how near those have to be
  uint64_t attached_components = 0;  // that take the nearest part's label
  uint64_t attached_faces = 0;       // of those
  uint64_t worn_components = 0;      // whose faces take the labels beneath them
  uint64_t body_vertices = 0;        // that are computed on
  uint64_t coarse_vertices = 0;      // of those, on coarse meshes
  double area = 0;  // inf or 0 where it leaves the range of a double
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
};

// Fills the members that can be seen from the mesh alone: vertices, faces and
// everything from zero_area_faces on; the others stay 0. Of no use once
// cancelled. REQUIRES: a face, finite positions, every vertex in a face. Thread
// safe.
MeshReport ReportOn(const TriangleMesh& mesh,
                    const CancelToken& cancel = CancelToken());

}  // namespace marrow

#endif  // MARROW_CORE_MESH_MESH_REPORT_H_
