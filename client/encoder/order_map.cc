#include "client/encoder/order_map.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "client/encoder/face_neighbours.h"
#include "client/segmentation.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

using client::kNone;

double Area(const PolygonMesh& mesh, const std::array<uint32_t, 3>& triangle) {
  std::array<Eigen::Vector3d, 3> p;
  for (int i = 0; i < 3; ++i) {
    p[i] = Eigen::Vector3d(mesh.positions[triangle[i]].data());
  }
  const double area = (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
  return std::isfinite(area) ? area : 0;
}

std::vector<bool> UsedVertices(const PolygonMesh& mesh) {
  std::vector<bool> used(mesh.NumVertices(), false);
  for (const uint32_t v : mesh.face_vertices) used[v] = true;
  return used;
}

// Of the vertices of each site the first that is used, else the first.
std::vector<uint32_t> RepresentVertices(const PayloadOrigin& origin,
                                        const std::vector<bool>& used) {
  std::vector<uint32_t> representative(origin.site_of_vertex.size(), kNone);
  for (const bool only_used : {true, false}) {
    for (uint32_t v = 0; v < origin.site_of_vertex.size(); ++v) {
      uint32_t& chosen = representative[origin.site_of_vertex[v]];
      if (chosen == kNone && (used[v] || !only_used)) chosen = v;
    }
  }
  return representative;
}

absl::Status CheckCount(size_t got, size_t expected, const char* what) {
  if (got == expected) return absl::OkStatus();
  return absl::InternalError(absl::StrCat("the answer has ", got,
                                          " labels for ", expected, " ", what));
}

// Of the triangles [begin, end) of a polygon that are in the payload the one
// with the largest area; kNone without any. Areas that differ by rounding alone
// are equal: then the one whose corners sum up to the least position, wherever
// in the file the polygon begins.
uint32_t LargestTriangle(const PolygonMesh& mesh, const PayloadOrigin& origin,
                         const std::vector<uint32_t>& decoded_face,
                         uint32_t begin, uint32_t end) {
  constexpr double kRounding = 1e-9;
  const auto sum = [&](uint32_t t) {
    std::array<double, 3> sum{};
    for (uint32_t v : origin.triangles[t])
      for (int i = 0; i < 3; ++i) sum[i] += mesh.positions[v][i];
    return sum;
  };
  uint32_t best = kNone;
  double best_area = 0;
  for (uint32_t t = begin; t < end; ++t) {
    if (decoded_face[t] == kNone) continue;
    const double area = Area(mesh, origin.triangles[t]);
    if (best != kNone &&
        (area < best_area * (1 - kRounding) ||
         (area <= best_area * (1 + kRounding) && sum(t) >= sum(best))))
      continue;
    best = t;
    best_area = area;
  }
  return best;
}

}  // namespace

OrderMap::OrderMap(const PolygonMesh& mesh, const PayloadOrigin& origin)
    : num_decoded_faces_(
          static_cast<uint32_t>(origin.triangle_of_decoded_face.size())) {
  std::vector<uint32_t> decoded_face(origin.triangles.size(), kNone);
  for (uint32_t d = 0; d < num_decoded_faces_; ++d)
    decoded_face[origin.triangle_of_decoded_face[d]] = d;
  std::vector<uint32_t> triangle(mesh.NumFaces());
  std::vector<bool> in_payload(mesh.NumFaces());
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    triangle[f] =
        LargestTriangle(mesh, origin, decoded_face, origin.triangle_begin[f],
                        origin.triangle_begin[f + 1]);
    in_payload[f] = triangle[f] != kNone;
  }
  const std::vector<uint32_t> stand_in =
      FindStandIns(mesh, origin.site_of_vertex, in_payload);
  for (uint32_t f : stand_in)
    decoded_face_of_face_.push_back(decoded_face[triangle[f]]);

  const std::vector<bool> used = UsedVertices(mesh);
  const std::vector<uint32_t> representative = RepresentVertices(origin, used);
  std::vector<uint32_t> point_of_site(mesh.NumVertices(), kNone);
  for (uint32_t p = 0; p < origin.site_of_decoded_point.size(); ++p) {
    const uint32_t site = origin.site_of_decoded_point[p];
    point_of_site[site] = std::min(point_of_site[site], p);
    vertex_of_point_.push_back(representative[site]);
  }
  point_of_vertex_.assign(mesh.NumVertices(), kNone);
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    if (used[v]) point_of_vertex_[v] = point_of_site[origin.site_of_vertex[v]];
  }
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    if (in_payload[f]) continue;
    const uint32_t corner = origin.triangles[triangle[stand_in[f]]][0];
    const uint32_t point = point_of_site[origin.site_of_vertex[corner]];
    for (const uint32_t v : mesh.Face(f))
      if (point_of_vertex_[v] == kNone) point_of_vertex_[v] = point;
  }
}

uint32_t OrderMap::NumUnusedVertices() const {
  return static_cast<uint32_t>(
      std::count(point_of_vertex_.begin(), point_of_vertex_.end(), kNone));
}

absl::StatusOr<std::vector<uint32_t>> OrderMap::FaceLabelsInFileOrder(
    std::span<const uint32_t> decoded_face_labels) const {
  MARROW_RETURN_IF_ERROR(
      CheckCount(decoded_face_labels.size(), num_decoded_faces_, "faces"));
  std::vector<uint32_t> labels;
  labels.reserve(decoded_face_of_face_.size());
  for (const uint32_t face : decoded_face_of_face_)
    labels.push_back(decoded_face_labels[face]);
  return labels;
}

absl::StatusOr<std::vector<uint32_t>> OrderMap::VertexLabelsInFileOrder(
    std::span<const uint32_t> decoded_point_labels) const {
  MARROW_RETURN_IF_ERROR(
      CheckCount(decoded_point_labels.size(), NumDecodedPoints(), "points"));
  std::vector<uint32_t> labels;
  labels.reserve(point_of_vertex_.size());
  for (const uint32_t point : point_of_vertex_) {
    labels.push_back(point == kNone ? kNone : decoded_point_labels[point]);
  }
  return labels;
}

absl::StatusOr<std::vector<uint32_t>> OrderMap::FileVertices(
    std::span<const uint32_t> decoded_points) const {
  std::vector<uint32_t> vertices;
  vertices.reserve(decoded_points.size());
  for (const uint32_t point : decoded_points) {
    if (point >= NumDecodedPoints()) {
      return absl::InternalError(absl::StrCat("the answer names point ", point,
                                              " of ", NumDecodedPoints()));
    }
    vertices.push_back(vertex_of_point_[point]);
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace marrow
