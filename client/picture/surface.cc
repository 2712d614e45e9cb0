#include "client/picture/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/container/flat_hash_map.h"

namespace marrow {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

bool IsFinite(const std::array<double, 3>& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

bool IsDrawable(const PolygonMesh& mesh, size_t f) {
  const std::span<const uint32_t> face = mesh.Face(f);
  return face.size() >= 3 &&
         std::all_of(face.begin(), face.end(), [&mesh](uint32_t v) {
           return IsFinite(mesh.positions[v]);
         });
}

// Numbers for the corners: equal positions share one, so that normals are
// smooth over the seams of files that repeat vertices.
class Welder {
 public:
  explicit Welder(const PolygonMesh& mesh)
      : mesh_(mesh), ids_(mesh.NumVertices(), kUnseen) {}

  uint32_t Id(uint32_t vertex) {
    uint32_t& id = ids_[vertex];
    if (id == kUnseen) {
      const auto next = static_cast<uint32_t>(vertices_.size());
      const auto [it, inserted] =
          by_position_.try_emplace(mesh_.positions[vertex], next);
      if (inserted) vertices_.push_back(vertex);
      id = it->second;
    }
    return id;
  }
  // A vertex for each number.
  const std::vector<uint32_t>& vertices() const { return vertices_; }

 private:
  static constexpr uint32_t kUnseen = 0xFFFFFFFFu;

  const PolygonMesh& mesh_;
  std::vector<uint32_t> ids_;
  std::vector<uint32_t> vertices_;
  absl::flat_hash_map<std::array<double, 3>, uint32_t> by_position_;
};

void PlacePoints(const PolygonMesh& mesh, const std::vector<uint32_t>& vertices,
                 Surface& surface) {
  if (vertices.empty()) return;
  const auto position = [&mesh](uint32_t v) {
    return Eigen::Map<const Vector3d>(mesh.positions[v].data());
  };
  Vector3d low = position(vertices[0]);
  Vector3d high = low;
  for (uint32_t v : vertices) {
    low = low.cwiseMin(position(v));
    high = high.cwiseMax(position(v));
  }
  const double side = (high - low).maxCoeff();
  surface.center = (low + high) / 2;
  surface.scale = side > 0 ? 2 / side : 1;
  for (uint32_t v : vertices) {
    surface.points.push_back(
        ((position(v) - surface.center) * surface.scale).cast<float>());
  }
}

float Angle(const Vector3f& u, const Vector3f& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

void AddNormals(Surface& surface) {
  surface.normals.assign(surface.points.size(), Vector3f::Zero());
  for (const auto& triangle : surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Vector3f& a = surface.points[triangle[i]];
      const Vector3f u = surface.points[triangle[(i + 1) % 3]] - a;
      const Vector3f v = surface.points[triangle[(i + 2) % 3]] - a;
      surface.normals[triangle[i]] +=
          Angle(u, v) * u.cross(v).stableNormalized();
    }
  }
  for (Vector3f& normal : surface.normals) {
    if (normal.norm() > 1e-3f) {
      normal.normalize();
    } else {
      normal.setZero();
    }
  }
}

}  // namespace

Surface MakeSurface(const PolygonMesh& mesh,
                    std::span<const uint32_t> face_labels) {
  Surface surface;
  Welder welder(mesh);
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    if (!IsDrawable(mesh, f)) continue;
    const std::span<const uint32_t> face = mesh.Face(f);
    for (size_t i = 2; i < face.size(); ++i) {
      surface.triangles.push_back(
          {welder.Id(face[0]), welder.Id(face[i - 1]), welder.Id(face[i])});
      surface.labels.push_back(face_labels[f]);
    }
  }
  PlacePoints(mesh, welder.vertices(), surface);
  AddNormals(surface);
  return surface;
}

}  // namespace marrow
