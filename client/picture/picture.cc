#include "client/picture/picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "client/picture/camera.h"
#include "client/picture/image.h"
#include "client/picture/overlay.h"
#include "client/picture/raster.h"
#include "client/picture/shading.h"
#include "client/picture/surface.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

using Eigen::AlignedBox2f;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr Rgb kBackground = {247, 247, 245};

absl::Status Check(const PolygonMesh& mesh,
                   std::span<const uint32_t> face_labels,
                   const PictureOptions& options) {
  if (face_labels.size() != mesh.NumFaces()) {
    return absl::InvalidArgumentError(
        absl::StrCat("got ", face_labels.size(), " face labels for a mesh of ",
                     mesh.NumFaces(), " faces; pass one label a face"));
  }
  const auto in_range = [](int side) { return side >= 16 && side <= 4096; };
  if (!in_range(options.width) || !in_range(options.height)) {
    return absl::InvalidArgumentError(
        absl::StrCat("a picture of ", options.width, " x ", options.height,
                     " pixels: both sides must be between 16 and 4096"));
  }
  if (options.num_views < 1 || options.num_views > 2) {
    return absl::InvalidArgumentError(absl::StrCat(
        "a picture of ", options.num_views, " views: it can have 1 or 2"));
  }
  return absl::OkStatus();
}

// A view's place in the picture.
struct Panel {
  View view;
  AlignedBox2f box;  // of the turned surface
  int left = 0;      // pixels
  int width = 0;
  float scale = 1;                     // pixels a unit
  Vector2f origin = Vector2f::Zero();  // of the surface, in pixels

  Vector3f ToPixels(const Vector3f& point) const {
    const Vector3f p = view * point;
    return {origin.x() + scale * p.x(), origin.y() - scale * p.y(),
            scale * p.z()};
  }
};

AlignedBox2f TurnedBox(const Surface& surface, const View& view) {
  AlignedBox2f box(Vector2f::Zero());
  for (const Vector3f& p : surface.points) box.extend((view * p).head<2>());
  return box;
}

// All panels have one scale, so that lengths compare, and share the width as
// their contents need it.
std::vector<Panel> LayOut(const Surface& surface,
                          const PictureOptions& options) {
  std::vector<Panel> panels;
  float total_width = 0;
  float most_height = 0;
  for (const View& view : ChooseViews(surface, options.num_views)) {
    panels.push_back({.view = view, .box = TurnedBox(surface, view)});
    total_width += std::max(panels.back().box.sizes().x(), 0.2f);
    most_height = std::max(most_height, panels.back().box.sizes().y());
  }
  const float margin = 0.05f * std::min(options.width, options.height);
  const float room_x =
      options.width - margin * (1 + static_cast<float>(panels.size()));
  const float room_y = options.height - 2 * margin;
  const float scale =
      std::min(room_x / total_width, room_y / std::max(most_height, 0.1f));
  const float spare =
      (options.width - scale * total_width) / static_cast<float>(panels.size());
  float left = 0;
  for (Panel& panel : panels) {
    const float width = scale * std::max(panel.box.sizes().x(), 0.2f) + spare;
    panel.scale = scale;
    panel.left = static_cast<int>(std::lround(left));
    panel.width =
        std::min(static_cast<int>(std::lround(left + width)), options.width) -
        panel.left;
    const Vector2f center = panel.box.center();
    panel.origin = {left + width / 2 - scale * center.x(),
                    options.height / 2.0f + scale * center.y()};
    left += width;
  }
  return panels;
}

void DrawPanel(const Surface& surface, const client::Skeleton& skeleton,
               const Panel& panel, Image& image) {
  std::vector<Vector3f> points;
  points.reserve(surface.points.size());
  const Vector3f left(static_cast<float>(panel.left), 0, 0);
  for (const Vector3f& p : surface.points) {
    points.push_back(kSupersampling * (panel.ToPixels(p) - left));
  }
  DepthBuffer buffer(panel.width * kSupersampling,
                     image.height * kSupersampling);
  Rasterize(points, surface.triangles, buffer);
  Shade(surface, panel.view, points, buffer, panel.left, image);

  std::vector<Vector2f> joints;
  for (const client::Joint& joint : skeleton.joints) {
    joints.push_back(panel.ToPixels(surface.Place(joint.position)).head<2>());
  }
  const float unit = std::max(0.0045f * image.height, 1.0f);
  DrawSkeleton(skeleton, joints, unit, image);
}

}  // namespace

absl::StatusOr<std::string> DrawPng(const PolygonMesh& mesh,
                                    std::span<const uint32_t> face_labels,
                                    const client::Skeleton& skeleton,
                                    const PictureOptions& options) {
  MARROW_RETURN_IF_ERROR(Check(mesh, face_labels, options));
  const Surface surface = MakeSurface(mesh, face_labels);
  Image image(options.width, options.height, ToLinear(kBackground));
  for (const Panel& panel : LayOut(surface, options)) {
    DrawPanel(surface, skeleton, panel, image);
  }
  return EncodePng(image);
}

}  // namespace marrow
