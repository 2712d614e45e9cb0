#include "core/operators/attachment.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancellable.h"
#include "core/base/status_macros.h"
#include "core/mesh/unit_box.h"
#include "core/operators/body_tree.h"
#include "core/operators/laplacian.h"
#include "core/operators/nearest_face.h"
#include "core/operators/surface_points.h"

namespace marrow {
namespace {

// Layers upon layers: shirt, waistcoat, coat.
constexpr int kMostLayers = 8;

using Components = std::vector<std::vector<uint32_t>>;

// Points that stand for the area of components.
struct AreaPoints {
  Positions places;  // a row a point
  std::vector<uint32_t> component;
  std::vector<double> area;
};

// Those that `keep(point)` says.
template <typename Keep>
AreaPoints Some(const AreaPoints& points, const Keep& keep) {
  AreaPoints some;
  some.places.resize(points.places.rows(), 3);
  for (uint32_t i = 0; i < points.area.size(); ++i) {
    if (!keep(i)) continue;
    some.places.row(static_cast<Eigen::Index>(some.area.size())) =
        points.places.row(i);
    some.component.push_back(points.component[i]);
    some.area.push_back(points.area[i]);
  }
  some.places.conservativeResize(static_cast<Eigen::Index>(some.area.size()),
                                 3);
  return some;
}

// Vertices, and points inside coarse faces. `near` and the places are in the
// unit of the box.
AreaPoints PointsOf(const TriangleMesh& mesh, const Components& components,
                    const Positions& vertices, double near) {
  const FacePoints inside = PointsInFaces(mesh, vertices, near);
  const Eigen::Index n = vertices.rows();
  AreaPoints points;
  points.places.resize(n + inside.places.rows(), 3);
  points.places << vertices, inside.places;
  const auto count = static_cast<size_t>(points.places.rows());
  points.component.assign(count, kNoIndex);
  points.area.assign(count, 0);
  std::vector<uint32_t> component(mesh.NumFaces(), kNoIndex);
  for (uint32_t c = 0; c < components.size(); ++c)
    for (uint32_t f : components[c]) component[f] = c;
  std::vector<double> share = FaceAreaShares(mesh);
  std::vector<uint32_t> points_of_face(mesh.NumFaces(), 3);
  for (uint32_t f : inside.face) ++points_of_face[f];
  const auto add = [&](size_t point, uint32_t f) {
    points.component[point] = component[f];
    points.area[point] += share[f] / points_of_face[f];
  };
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (component[f] != kNoIndex)
      for (uint32_t v : mesh.faces[f]) add(v, f);
  for (size_t i = 0; i < inside.face.size(); ++i)
    add(static_cast<size_t>(n) + i, inside.face[i]);
  return Some(points,
              [&](uint32_t i) { return points.component[i] != kNoIndex; });
}

// Which components have kWornShare of their area near larger ones.
absl::StatusOr<std::vector<bool>> NearLarger(const AreaPoints& points,
                                             size_t components,
                                             double near_square,
                                             const CancelToken& cancel) {
  BodyTree tree(points.places, cancel);
  tree.SetBodies(points.component);
  std::vector<double> area(components, 0), near(components, 0);
  MARROW_RETURN_IF_ERROR(
      ForEachIndex(points.area.size(), cancel, [&](uint32_t i) {
        const uint32_t own = points.component[i];
        area[own] += points.area[i];
        Candidate nearest{near_square};
        if (own > 0) tree.Improve(i, nearest);
        const auto [a, b] = nearest.ends;
        if (nearest.IsBridge() && points.component[a == i ? b : a] < own)
          near[own] += points.area[i];
      }));
  std::vector<bool> is_near(components);
  for (size_t c = 0; c < components; ++c)
    is_near[c] = area[c] > 0 && near[c] >= kWornShare * area[c];
  return is_near;
}

// Where a corner of what is attached is nearest to the bodies.
struct Contact {
  double distance = 0;
  Eigen::RowVector3d place = Eigen::RowVector3d::Zero();
  uint32_t face = 0;
};

// The face in the midst of where the faces are nearest to the bodies.
absl::StatusOr<uint32_t> FaceTouched(const TriangleMesh& mesh,
                                     const NearestFace& nearest,
                                     const std::vector<uint32_t>& faces,
                                     const CancelToken& cancel) {
  std::vector<Contact> contacts;
  Eigen::RowVector3d low = nearest.PlaceOf(mesh.faces[faces[0]][0]), high = low;
  MARROW_RETURN_IF_ERROR(ForEachIndex(faces.size(), cancel, [&](size_t i) {
    for (uint32_t v : mesh.faces[faces[i]]) {
      const Eigen::RowVector3d place = nearest.PlaceOf(v);
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
      const NearestFace::Found found = nearest.To(place);
      contacts.push_back(
          {std::sqrt(found.distance_square), found.place, found.face});
    }
  }));
  double reach = std::ranges::min(contacts, {}, &Contact::distance).distance +
                 kContact * (high - low).norm();
  std::erase_if(contacts,
                [&](const Contact& c) { return !(c.distance <= reach); });
  Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
  for (const Contact& contact : contacts)
    middle += contact.place / static_cast<double>(contacts.size());
  return std::ranges::min(contacts, {},
                          [&](const Contact& contact) {
                            return (contact.place - middle).squaredNorm();
                          })
      .face;
}

}  // namespace

absl::StatusOr<std::vector<bool>> FindWorn(const TriangleMesh& mesh,
                                           const Components& components,
                                           double near,
                                           const CancelToken& cancel) {
  std::vector<bool> is_worn(components.size(), false);
  if (components.size() < 2) return is_worn;
  const UnitPoints box = ToUnitBox(mesh);
  near /= box.unit;
  AreaPoints points = PointsOf(mesh, components, box.points, near);
  for (int layer = 0; layer < kMostLayers; ++layer) {
    MARROW_ASSIGN_OR_RETURN(
        const std::vector<bool> more,
        NearLarger(points, components.size(), near * near, cancel));
    if (std::ranges::find(more, true) == more.end()) break;
    for (size_t c = 0; c < more.size(); ++c)
      if (more[c]) is_worn[c] = true;
    points =
        Some(points, [&](uint32_t i) { return !more[points.component[i]]; });
  }
  return is_worn;
}

absl::Status Attach(const TriangleMesh& mesh,
                    const std::vector<const std::vector<uint32_t>*>& bodies,
                    const std::vector<Attachment>& attached, double near,
                    const CancelToken& cancel, std::vector<uint32_t>& anchors) {
  if (attached.empty()) return absl::OkStatus();
  std::vector<uint32_t> first_face(mesh.NumVertices(), kNoIndex);
  std::vector<bool> is_left(mesh.NumFaces(), true);
  for (const std::vector<uint32_t>* faces : bodies) {
    for (size_t i = faces->size(); i-- > 0;) {
      is_left[(*faces)[i]] = false;
      for (uint32_t v : mesh.faces[(*faces)[i]]) first_face[v] = (*faces)[i];
    }
  }
  const NearestFace nearest(mesh, first_face, is_left, near);
  for (const auto& [faces, is_worn] : attached) {
    if (is_worn) {
      MARROW_RETURN_IF_ERROR(ForEachIndex(faces.size(), cancel, [&](size_t i) {
        anchors[faces[i]] = nearest.To(nearest.CentreOf(faces[i])).face;
      }));
      continue;
    }
    MARROW_ASSIGN_OR_RETURN(const uint32_t touched,
                            FaceTouched(mesh, nearest, faces, cancel));
    for (uint32_t f : faces) anchors[f] = touched;
  }
  return absl::OkStatus();
}

}  // namespace marrow
