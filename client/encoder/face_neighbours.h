// Stand-ins for faces that carry no label of their own.
#ifndef MARROW_CLIENT_ENCODER_FACE_NEIGHBOURS_H_
#define MARROW_CLIENT_ENCODER_FACE_NEIGHBOURS_H_

#include <cstdint>
#include <vector>

#include "client/polygon_mesh.h"

namespace marrow {

// For every face of `mesh` that is not `labelled`, a labelled one: the first
// that shares an edge with it, else a vertex, else that with the nearest
// centre. A labelled face stands for itself. Vertices of one site count as the
// same. REQUIRES: some face is labelled. Deterministic.
std::vector<uint32_t> FindStandIns(const PolygonMesh& mesh,
                                   const std::vector<uint32_t>& site_of_vertex,
                                   const std::vector<bool>& labelled);

}  // namespace marrow

#endif  // MARROW_CLIENT_ENCODER_FACE_NEIGHBOURS_H_
