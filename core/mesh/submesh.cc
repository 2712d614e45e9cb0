// The vertices and faces of a canonical mesh are sorted, and numbering the ones
// that are kept in their old order leaves them so.
#include "core/mesh/submesh.h"

#include "core/mesh/mesh_report.h"

namespace marrow {

Submesh ExtractFaces(const TriangleMesh& mesh,
                     const std::vector<uint32_t>& faces,
                     const CancelToken& cancel) {
  std::vector<uint32_t> own(mesh.NumVertices(), kNoIndex);
  for (uint32_t f : faces)
    for (uint32_t v : mesh.faces[f]) own[v] = 0;
  Submesh result;
  for (uint32_t v = 0; v < own.size(); ++v) {
    if (own[v] == kNoIndex) continue;
    own[v] = static_cast<uint32_t>(result.vertices.size());
    result.vertices.push_back(v);
  }
  TriangleMesh& part = result.canonical.mesh;
  part.positions.resize(result.vertices.size(), 3);
  for (uint32_t v = 0; v < result.vertices.size(); ++v)
    part.positions.row(v) = mesh.positions.row(result.vertices[v]);
  part.faces.reserve(faces.size());
  for (uint32_t f : faces) {
    const auto [a, b, c] = mesh.faces[f];
    part.faces.push_back({own[a], own[b], own[c]});
  }
  result.canonical.report = ReportOn(part, cancel);
  if (cancel.IsCancelled()) return result;
  result.canonical.geometry_digest = GeometryDigestOf(part);
  return result;
}

}  // namespace marrow
