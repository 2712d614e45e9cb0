#include "core/operators/attachment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

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
  const std::vector<double> share = FaceAreaShares(mesh);
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

// Whether every edge has an even number of faces.
bool IsClosed(const TriangleMesh& mesh, const std::vector<uint32_t>& faces) {
  std::vector<std::pair<uint32_t, uint32_t>> edges;
  for (uint32_t f : faces)
    for (int i = 0; i < 3; ++i)
      edges.push_back(
          std::minmax({mesh.faces[f][i], mesh.faces[f][(i + 1) % 3]}));
  std::sort(edges.begin(), edges.end());
  size_t end;
  for (size_t i = 0; i < edges.size(); i = end) {
    for (end = i; end < edges.size() && edges[end] == edges[i];) ++end;
    if ((end - i) % 2 != 0) return false;
  }
  return true;
}

// Volume by area. A slab has half of its thickness, a rod of its radius.
double HalfThickness(const std::vector<Triangle>& all, const Positions& places,
                     const std::vector<uint32_t>& faces) {
  const Eigen::RowVector3d origin = places.row(all[faces[0]][0]);
  double volume = 0, area = 0;
  for (uint32_t f : faces) {
    const Eigen::RowVector3d a = places.row(all[f][0]) - origin;
    const Eigen::RowVector3d b = places.row(all[f][1]) - origin;
    const Eigen::RowVector3d c = places.row(all[f][2]) - origin;
    volume += a.dot(b.cross(c)) / 6;
    area += (b - a).cross(c - a).norm() / 2;
  }
  return area > 0 ? std::abs(volume) / area : 0;
}

// How near to another each component has to be to be worn by it: within half of
// its own thickness, where it is closed. The far side of a thin limb that lies
// against the body is farther off than that; all of a suit, or of a body in
// one, is not.
std::vector<double> Limits(const TriangleMesh& mesh,
                           const Components& components,
                           const Positions& places, double near) {
  std::vector<double> limits;
  for (const std::vector<uint32_t>& faces : components)
    limits.push_back(
        IsClosed(mesh, faces)
            ? std::min(near, HalfThickness(mesh.faces, places, faces))
            : near);
  return limits;
}

// Which components have enough of their area within their limits of larger
// ones, or of others and most of it of one that is larger.
absl::StatusOr<std::vector<bool>> NearLarger(const AreaPoints& points,
                                             const std::vector<double>& limits,
                                             const CancelToken& cancel) {
  BodyTree tree(points.places, cancel);
  tree.SetBodies(points.component);
  std::vector<double> area(limits.size(), 0);
  std::vector<std::map<uint32_t, double>> near(limits.size());
  MARROW_RETURN_IF_ERROR(
      ForEachIndex(points.area.size(), cancel, [&](uint32_t i) {
        const uint32_t own = points.component[i];
        area[own] += points.area[i];
        Candidate nearest{limits[own] * limits[own]};
        if (own > 0) tree.Improve(i, nearest);
        const auto [a, b] = nearest.ends;
        if (!nearest.IsBridge()) return;
        near[own][points.component[a == i ? b : a]] += points.area[i];
      }));
  std::vector<bool> is_near(limits.size(), false);
  for (uint32_t c = 0; c < limits.size(); ++c) {
    double sum = 0, larger = 0, most = 0;
    for (const auto& [other, share] : near[c]) {
      sum += share;
      if (other > c) continue;
      larger += share;
      most = std::max(most, share);
    }
    is_near[c] =
        area[c] > 0 && sum >= kWornShare * area[c] &&
        (larger >= kWornShare * area[c] || most >= kWearerShare * area[c]);
  }
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
  const double reach =
      std::ranges::min(contacts, {}, &Contact::distance).distance +
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
  const std::vector<double> limits = Limits(mesh, components, box.points, near);
  AreaPoints points = PointsOf(mesh, components, box.points, near);
  for (int layer = 0; layer < kMostLayers; ++layer) {
    MARROW_ASSIGN_OR_RETURN(const std::vector<bool> more,
                            NearLarger(points, limits, cancel));
    if (std::ranges::find(more, true) == more.end()) break;
    for (size_t c = 0; c < more.size(); ++c)
      if (more[c]) is_worn[c] = true;
    points =
        Some(points, [&](uint32_t i) { return !more[points.component[i]]; });
  }
  return is_worn;
}

absl::Status Attach(const TriangleMesh& mesh, std::vector<uint32_t> bodies,
                    const std::vector<Attachment>& attached, double near,
                    const CancelToken& cancel, std::vector<uint32_t>& anchors) {
  if (attached.empty()) return absl::OkStatus();
  const NearestFace of_bodies(mesh, bodies, NearestFace::By::kCorners, near);
  for (const auto& [faces, is_worn] : attached) {
    if (is_worn) continue;
    MARROW_ASSIGN_OR_RETURN(const uint32_t touched,
                            FaceTouched(mesh, of_bodies, faces, cancel));
    for (uint32_t f : faces) anchors[f] = touched;
    bodies.insert(bodies.end(), faces.begin(), faces.end());
  }
  if (std::ranges::none_of(attached, &Attachment::is_worn))
    return absl::OkStatus();
  // What wears it may be attached itself.
  const NearestFace beneath(mesh, bodies, NearestFace::By::kCentres, near);
  for (const Attachment& worn : attached) {
    if (!worn.is_worn) continue;
    const auto follow = [&](size_t i) {
      const uint32_t f = worn.faces[i];
      anchors[f] = anchors[beneath.To(beneath.CentreOf(f)).face];
    };
    MARROW_RETURN_IF_ERROR(ForEachIndex(worn.faces.size(), cancel, follow));
  }
  return absl::OkStatus();
}

}  // namespace marrow
