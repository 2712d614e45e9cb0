#include "core/operators/tufted_cover.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace marrow {
namespace {

// Which side of face f edge e is.
uint32_t SideIndex(const Adjacency& adjacency, uint32_t f, uint32_t e) {
  const auto& edges = adjacency.FaceEdges(f);
  return edges[0] == e ? 0 : edges[1] == e ? 1 : 2;
}

// Whether side i of the face runs from the lesser vertex to the greater.
bool Ascends(const Triangle& face, uint32_t i) {
  return face[i] < face[(i + 1) % 3];
}

// The angle of each face about edge e, seen along its ascending direction and
// beginning at the first face.
std::vector<double> SheetAngles(const TriangleMesh& mesh,
                                const Adjacency& adjacency, uint32_t e) {
  const std::array<uint32_t, 2> ends = adjacency.EdgeVertices(e);
  const std::span<const uint32_t> faces = adjacency.EdgeFaces(e);
  const Eigen::Vector3d origin = mesh.Position(ends[0]);
  const Eigen::Vector3d along =
      (mesh.Position(ends[1]) - origin).stableNormalized();
  auto direction = [&](uint32_t f) -> Eigen::Vector3d {
    const uint32_t apex = mesh.faces[f][(SideIndex(adjacency, f, e) + 2) % 3];
    const Eigen::Vector3d w = (mesh.Position(apex) - origin).stableNormalized();
    return w - w.dot(along) * along;
  };
  const Eigen::Vector3d x = direction(faces[0]), y = along.cross(x);
  std::vector<double> angles;
  angles.reserve(faces.size());
  for (uint32_t f : faces) {
    const Eigen::Vector3d w = direction(f);
    angles.push_back(std::atan2(w.dot(y), w.dot(x)));
  }
  return angles;
}

// Equal angles are in order of the faces.
std::vector<uint32_t> SortedSheets(const TriangleMesh& mesh,
                                   const Adjacency& adjacency, uint32_t e) {
  const std::span<const uint32_t> faces = adjacency.EdgeFaces(e);
  // Round a circle of one or two there is one order.
  if (faces.size() < 3) return {faces.begin(), faces.end()};
  const std::vector<double> angles = SheetAngles(mesh, adjacency, e);
  std::vector<uint32_t> order(faces.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t i, uint32_t j) {
    return angles[i] < angles[j];
  });
  for (uint32_t& i : order) i = faces[i];
  return order;
}

}  // namespace

bool IsClosedAndOriented(const TriangleMesh& mesh, const Adjacency& adjacency) {
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const std::span<const uint32_t> faces = adjacency.EdgeFaces(e);
    if (faces.size() != 2) return false;
    auto ascends = [&](uint32_t f) {
      return Ascends(mesh.faces[f], SideIndex(adjacency, f, e));
    };
    if (ascends(faces[0]) == ascends(faces[1])) return false;
  }
  return true;
}

GluedTriangles GlueFaces(const TriangleMesh& mesh, const Adjacency& adjacency) {
  GluedTriangles glued;
  glued.corners.reserve(3 * mesh.faces.size());
  for (const Triangle& face : mesh.faces)
    glued.corners.insert(glued.corners.end(), face.begin(), face.end());
  glued.edges.reserve(adjacency.NumEdges());
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    auto side = [&](uint32_t f) { return 3 * f + SideIndex(adjacency, f, e); };
    const std::span<const uint32_t> faces = adjacency.EdgeFaces(e);
    glued.edges.push_back({side(faces[0]), side(faces[1])});
  }
  glued.mesh_edge.resize(adjacency.NumEdges());
  std::iota(glued.mesh_edge.begin(), glued.mesh_edge.end(), 0);
  return glued;
}

GluedTriangles GlueTuftedCover(const TriangleMesh& mesh,
                               const Adjacency& adjacency) {
  GluedTriangles glued;
  glued.sheets = 2;
  glued.corners.reserve(6 * mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces)
    glued.corners.insert(glued.corners.end(), {a, b, c, a, c, b});
  glued.edges.reserve(3 * mesh.faces.size());
  glued.mesh_edge.reserve(3 * mesh.faces.size());
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const std::vector<uint32_t> sheets = SortedSheets(mesh, adjacency, e);
    // Side i of the front is side 2 - i of the back, the other way round.
    auto side = [&](uint32_t f, bool ascending) {
      const uint32_t i = SideIndex(adjacency, f, e);
      return Ascends(mesh.faces[f], i) == ascending ? 6 * f + i
                                                    : 6 * f + 3 + (2 - i);
    };
    for (size_t k = 0; k < sheets.size(); ++k) {
      const uint32_t next = sheets[(k + 1) % sheets.size()];
      glued.edges.push_back({side(sheets[k], true), side(next, false)});
      glued.mesh_edge.push_back(e);
    }
  }
  return glued;
}

}  // namespace marrow
