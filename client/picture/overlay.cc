#include "client/picture/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "client/exporters/palette.h"

namespace marrow {
namespace {

using Eigen::Vector2f;

constexpr Rgb kOutline = {255, 255, 255};
constexpr Rgb kBone = {38, 42, 52};
constexpr Rgb kSegment = {34, 102, 214};
constexpr Rgb kArticulation = {150, 154, 160};

// Everything is a stroke: the points within `radius` of the segment a b, of
// which a disc is the case a = b.
struct Stroke {
  Vector2f a;
  Vector2f b;
  float radius;
};

float Distance(const Stroke& stroke, const Vector2f& p) {
  const Vector2f d = stroke.b - stroke.a;
  const float length2 = d.squaredNorm();
  const float t =
      length2 > 0 ? std::clamp((p - stroke.a).dot(d) / length2, 0.f, 1.f) : 0;
  return (p - stroke.a - t * d).norm();
}

// The columns that a row of the stroke can touch.
std::pair<float, float> Columns(const Stroke& stroke, float y, float reach) {
  const Vector2f d = stroke.b - stroke.a;
  float from = 0;
  float to = 1;
  if (std::abs(d.y()) > 1e-3f) {
    const float t1 = (y - reach - stroke.a.y()) / d.y();
    const float t2 = (y + reach - stroke.a.y()) / d.y();
    from = std::clamp(std::min(t1, t2), 0.0f, 1.0f);
    to = std::clamp(std::max(t1, t2), 0.0f, 1.0f);
  }
  const auto [low, high] =
      std::minmax({stroke.a.x() + from * d.x(), stroke.a.x() + to * d.x()});
  return {low - reach, high + reach};
}

// Neither infinite nor so far out that its distances would be.
bool IsDrawable(const Vector2f& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() < 1e6f;
}

int ToPixel(float x, int size) {
  return static_cast<int>(std::clamp(x, 0.0f, size - 1.0f));
}

void Draw(const Stroke& stroke, const Rgb& rgb, Image& image) {
  const Color color = ToLinear(rgb);
  const float reach = stroke.radius + 1;
  const auto [low, high] = std::minmax({stroke.a.y(), stroke.b.y()});
  const int last_row = ToPixel(high + reach, image.height);
  for (int y = ToPixel(low - reach, image.height); y <= last_row; ++y) {
    const auto [left, right] = Columns(stroke, y + 0.5f, reach);
    const int last = ToPixel(right, image.width);
    for (int x = ToPixel(left, image.width); x <= last; ++x) {
      const float distance = Distance(stroke, {x + 0.5f, y + 0.5f});
      const float cover =
          std::clamp(stroke.radius + 0.5f - distance, 0.0f, 1.0f);
      if (cover > 0) image.At(x, y) += cover * (color - image.At(x, y));
    }
  }
}

void DrawJoint(const client::Joint& joint, const Vector2f& at, float unit,
               Image& image) {
  const bool root = joint.parent == client::kNone;
  const float radius = joint.articulation ? 1.6f * unit : 2.2f * unit;
  if (root) {
    Draw({at, at, radius + 2.0f * unit}, kOutline, image);
    Draw({at, at, radius + 1.4f * unit}, kBone, image);
  }
  Draw({at, at, radius + 0.7f * unit}, kOutline, image);
  Draw({at, at, radius}, joint.articulation ? kArticulation : kSegment, image);
}

}  // namespace

void DrawSkeleton(const client::Skeleton& skeleton,
                  const std::vector<Vector2f>& positions, float unit,
                  Image& image) {
  const auto& joints = skeleton.joints;
  const auto draw_bones = [&](float radius, const Rgb& color) {
    for (size_t j = 0; j < joints.size(); ++j) {
      const uint32_t parent = joints[j].parent;
      if (parent >= joints.size()) continue;
      if (!IsDrawable(positions[j]) || !IsDrawable(positions[parent])) continue;
      Draw({positions[parent], positions[j], radius}, color, image);
    }
  };
  draw_bones(unit, kOutline);
  draw_bones(0.5f * unit, kBone);
  for (const bool articulation : {true, false}) {
    for (size_t j = 0; j < joints.size(); ++j) {
      if (joints[j].articulation != articulation) continue;
      if (!IsDrawable(positions[j])) continue;
      DrawJoint(joints[j], positions[j], unit, image);
    }
  }
}

}  // namespace marrow
