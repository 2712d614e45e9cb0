// Light is a wide sky, a warm floor and one key light over the viewer's left
// shoulder. Hollows are darkened by screen-space ambient occlusion, after
// McGuire et al., "The Alchemy screen-space ambient obscurance algorithm"
// (2011): a point is as dark as the points around it in the picture stand
// above its tangent plane.
#include "client/picture/shading.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>

#include "client/exporters/palette.h"

namespace marrow {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kTaps = 20;

class Shader {
 public:
  Shader(const Surface& surface, const View& view,
         const std::vector<Vector3f>& points, const DepthBuffer& buffer);

  // The light of the pixel and how much of it the surface covers.
  std::pair<Color, float> Pixel(int x, int y) const;

 private:
  Vector3f NormalAt(int x, int y) const;
  float Openness(int x, int y) const;
  void ComputeOpenness();
  float LineStrength(int x, int y) const;
  uint32_t LabelAt(size_t at) const {
    return surface_.labels[buffer_.triangle[at]];
  }

  const Surface& surface_;
  const View& view_;
  const std::vector<Vector3f>& points_;
  const DepthBuffer& buffer_;
  const float size_;  // of the picture's shorter side, in samples
  std::map<uint32_t, Color> colors_;
  std::vector<float> openness_;  // a pixel
};

Shader::Shader(const Surface& surface, const View& view,
               const std::vector<Vector3f>& points, const DepthBuffer& buffer)
    : surface_(surface),
      view_(view),
      points_(points),
      buffer_(buffer),
      size_(static_cast<float>(std::min(buffer.width, buffer.height))) {
  for (uint32_t label : surface.labels) {
    const auto [it, inserted] = colors_.try_emplace(label);
    if (inserted) it->second = ToLinear(SegmentColor(label));
  }
  ComputeOpenness();
}

// The normal in the view's axes, turned to the viewer.
Vector3f Shader::NormalAt(int x, int y) const {
  const uint32_t t = buffer_.triangle[buffer_.At(x, y)];
  const auto& corners = surface_.triangles[t];
  const Vector3f& a = points_[corners[0]];
  const Vector3f u = points_[corners[1]] - a;
  const Vector3f v = points_[corners[2]] - a;
  const Vector2f d = Vector2f(x + 0.5f, y + 0.5f) - a.head<2>();
  const float area = u.x() * v.y() - u.y() * v.x();
  const float s = std::clamp((d.x() * v.y() - d.y() * v.x()) / area, 0.f, 1.f);
  const float r = std::clamp((u.x() * d.y() - u.y() * d.x()) / area, 0.f, 1.f);
  // In samples y points down, so that cross products are mirrored.
  Vector3f flat = u.cross(v);
  flat = Vector3f(-flat.x(), flat.y(), -flat.z()).stableNormalized();
  Vector3f smooth = view_ * ((1 - s - r) * surface_.normals[corners[0]] +
                             s * surface_.normals[corners[1]] +
                             r * surface_.normals[corners[2]]);
  if (smooth.dot(flat) < 0.1f) smooth = flat;
  if (flat.z() < 0) smooth = -smooth;
  return smooth.stableNormalized();
}

// 1 in the open, towards 0 in a hollow.
float Shader::Openness(int x, int y) const {
  const float radius = 0.09f * size_;
  const size_t at = buffer_.At(x, y);
  const Vector3f normal = NormalAt(x, y);
  // Turning the taps from pixel to pixel makes fine noise out of bands, and the
  // blur takes that away.
  const float turn = std::fmod(
      0.7548777f * x / kSupersampling + 0.5698403f * y / kSupersampling, 1.0f);
  float occlusion = 0;
  for (int i = 0; i < kTaps; ++i) {
    const float distance = radius * (i + 0.5f) / kTaps;
    const float angle =
        2 * std::numbers::pi_v<float> * (turn + i * 0.381966f * 7);
    const float dx = distance * std::cos(angle);
    const float dy = distance * std::sin(angle);
    const int px = x + static_cast<int>(std::lround(dx));
    const int py = y + static_cast<int>(std::lround(dy));
    if (px < 0 || py < 0 || px >= buffer_.width || py >= buffer_.height) {
      continue;
    }
    const size_t tap = buffer_.At(px, py);
    if (buffer_.triangle[tap] == kNoTriangle) continue;
    const Vector3f v(px - x, y - py, buffer_.depth[tap] - buffer_.depth[at]);
    const float length = v.norm();
    if (length < 1 || length > 2 * radius) continue;
    const float above = std::max(normal.dot(v) / length - 0.08f, 0.0f);
    occlusion += above * (1 - length / (2 * radius));
  }
  return std::max(1 - 2.6f * occlusion / kTaps, 0.0f);
}

void Shader::ComputeOpenness() {
  const int width = buffer_.width / kSupersampling;
  const int height = buffer_.height / kSupersampling;
  std::vector<float> raw(static_cast<size_t>(width) * height, 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int sx = x * kSupersampling;
      const int sy = y * kSupersampling;
      if (buffer_.triangle[buffer_.At(sx, sy)] == kNoTriangle) continue;
      raw[size_t(y) * width + x] = Openness(sx, sy);
    }
  }
  const auto depth = [this](int x, int y) {
    return buffer_.depth[buffer_.At(x * kSupersampling, y * kSupersampling)];
  };
  openness_ = raw;
  constexpr int kBlur = 3;
  for (int y = kBlur; y < height - kBlur; ++y) {
    for (int x = kBlur; x < width - kBlur; ++x) {
      if (!std::isfinite(depth(x, y))) continue;
      float sum = 0;
      float weight = 0;
      for (int dy = -kBlur; dy <= kBlur; ++dy) {
        for (int dx = -kBlur; dx <= kBlur; ++dx) {
          if (!(std::abs(depth(x + dx, y + dy) - depth(x, y)) < 0.02f * size_))
            continue;
          sum += raw[size_t(y + dy) * width + x + dx];
          weight += 1;
        }
      }
      openness_[size_t(y) * width + x] = sum / weight;
    }
  }
}

// 1 on a boundary between segments, less on an outline.
float Shader::LineStrength(int x, int y) const {
  constexpr std::array<std::array<int, 2>, 12> kAround = {{{1, 0},
                                                           {-1, 0},
                                                           {0, 1},
                                                           {0, -1},
                                                           {1, 1},
                                                           {-1, 1},
                                                           {1, -1},
                                                           {-1, -1},
                                                           {2, 0},
                                                           {-2, 0},
                                                           {0, 2},
                                                           {0, -2}}};
  const size_t at = buffer_.At(x, y);
  float strength = 0;
  for (const auto& [dx, dy] : kAround) {
    const int px = x + dx;
    const int py = y + dy;
    if (px < 0 || py < 0 || px >= buffer_.width || py >= buffer_.height) {
      continue;
    }
    const size_t other = buffer_.At(px, py);
    if (buffer_.triangle[other] == kNoTriangle) {
      strength = std::max(strength, 0.45f);
    } else if (LabelAt(other) != LabelAt(at)) {
      return 1;
    } else if (buffer_.depth[other] - buffer_.depth[at] > 0.05f * size_) {
      strength = std::max(strength, 0.6f);
    }
  }
  return strength;
}

Color Light(const Color& base, const Vector3f& n, float openness) {
  static const Vector3f kKey = Vector3f(-0.45f, 0.6f, 0.75f).normalized();
  static const Vector3f kHalf = (kKey + Vector3f::UnitZ()).normalized();
  const Color sky(0.50f, 0.53f, 0.58f);
  const Color floor(0.30f, 0.27f, 0.25f);
  const float up = 0.5f + 0.5f * n.y();
  const Color ambient = openness * (up * sky + (1 - up) * floor);
  const float wrapped = std::max((n.dot(kKey) + 0.2f) / 1.2f, 0.0f);
  const Color key =
      wrapped * (0.4f + 0.6f * openness) * Color(0.78f, 0.75f, 0.70f);
  const float shine =
      0.10f * std::pow(std::max(n.dot(kHalf), 0.0f), 24.0f) * openness;
  return base.cwiseProduct(ambient + key) + Color::Constant(shine);
}

std::pair<Color, float> Shader::Pixel(int x, int y) const {
  const float openness =
      openness_[size_t(y) * (buffer_.width / kSupersampling) + x];
  Color sum = Color::Zero();
  int covered = 0;
  for (int i = 0; i < kSupersampling * kSupersampling; ++i) {
    const int sx = x * kSupersampling + i % kSupersampling;
    const int sy = y * kSupersampling + i / kSupersampling;
    const size_t at = buffer_.At(sx, sy);
    if (buffer_.triangle[at] == kNoTriangle) continue;
    const Color& base = colors_.find(LabelAt(at))->second;
    sum += Light(base, NormalAt(sx, sy), openness) *
           (1 - 0.85f * LineStrength(sx, sy));
    ++covered;
  }
  constexpr float kShare = 1.0f / (kSupersampling * kSupersampling);
  return {sum * kShare, covered * kShare};
}

}  // namespace

void Shade(const Surface& surface, const View& view,
           const std::vector<Vector3f>& points, const DepthBuffer& buffer,
           int left, Image& image) {
  const Shader shader(surface, view, points, buffer);
  for (int y = 0; y < buffer.height / kSupersampling; ++y) {
    for (int x = 0; x < buffer.width / kSupersampling; ++x) {
      const auto [light, coverage] = shader.Pixel(x, y);
      Color& pixel = image.At(left + x, y);
      pixel = light + (1 - coverage) * pixel;
    }
  }
}

}  // namespace marrow
