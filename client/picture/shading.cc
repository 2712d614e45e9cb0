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
constexpr int kTurns = 16;

// Spirals of unit radius, one turned a little further than the next.
using Spiral = std::array<Vector2f, kTaps>;

std::array<Spiral, kTurns> MakeSpirals() {
  constexpr float kTurnATap = 0.6737f;
  std::array<Spiral, kTurns> spirals;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (int i = 0; i < kTaps; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> *
                          (static_cast<float>(turn) / kTurns + i * kTurnATap);
      spirals[turn][i] =
          (i + 0.5f) / kTaps * Vector2f(std::cos(angle), std::sin(angle));
    }
  }
  return spirals;
}

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
  float Blurred(const std::vector<float>& values, int x, int y) const;
  // Of the pixel's first sample; minus infinity where it sees nothing.
  float PixelDepth(int x, int y) const {
    return buffer_.depth[buffer_.At(x * kSupersampling, y * kSupersampling)];
  }
  float LineStrength(int x, int y) const;
  void ComputeSegments();

  const Surface& surface_;
  const View& view_;
  const std::vector<Vector3f>& points_;
  const DepthBuffer& buffer_;
  const int width_;                 // pixels
  const int height_;                // pixels
  const float size_;                // of the picture's shorter side, in samples
  std::vector<Color> colors_;       // a segment
  std::vector<uint32_t> segments_;  // a sample: into colors_, or kNoTriangle
  const std::array<Spiral, kTurns> spirals_ = MakeSpirals();
  std::vector<float> openness_;  // a pixel
};

Shader::Shader(const Surface& surface, const View& view,
               const std::vector<Vector3f>& points, const DepthBuffer& buffer)
    : surface_(surface),
      view_(view),
      points_(points),
      buffer_(buffer),
      width_(buffer.width / kSupersampling),
      height_(buffer.height / kSupersampling),
      size_(static_cast<float>(std::min(buffer.width, buffer.height))) {
  ComputeSegments();
  ComputeOpenness();
}

void Shader::ComputeSegments() {
  std::map<uint32_t, uint32_t> numbers;
  std::vector<uint32_t> triangle_segments;
  for (uint32_t label : surface_.labels) {
    const auto next = static_cast<uint32_t>(colors_.size());
    const auto [it, inserted] = numbers.try_emplace(label, next);
    if (inserted) colors_.push_back(ToLinear(SegmentColor(label)));
    triangle_segments.push_back(it->second);
  }
  segments_.reserve(buffer_.triangle.size());
  for (uint32_t t : buffer_.triangle) {
    segments_.push_back(t == kNoTriangle ? kNoTriangle : triangle_segments[t]);
  }
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
  const float inverse = area != 0 ? 1 / area : 0;
  const float s =
      std::clamp((d.x() * v.y() - d.y() * v.x()) * inverse, 0.0f, 1.0f);
  const float r =
      std::clamp((u.x() * d.y() - u.y() * d.x()) * inverse, 0.0f, 1.0f);
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
  // Another turn at each pixel of a block of 4 x 4 makes fine noise out of
  // bands, and the blur takes that away.
  const int column = x / kSupersampling % 4;
  const int row = y / kSupersampling % 4;
  const Spiral& spiral = spirals_[(column * 4 + row) * 7 % kTurns];
  float occlusion = 0;
  for (const Vector2f& offset : spiral) {
    const int px = x + static_cast<int>(radius * offset.x());
    const int py = y + static_cast<int>(radius * offset.y());
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
  openness_.assign(static_cast<size_t>(width_) * height_, 1);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (!std::isfinite(PixelDepth(x, y))) continue;
      openness_[size_t(y) * width_ + x] =
          Openness(x * kSupersampling, y * kSupersampling);
    }
  }
  const std::vector<float> raw = openness_;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (!std::isfinite(PixelDepth(x, y))) continue;
      openness_[size_t(y) * width_ + x] = Blurred(raw, x, y);
    }
  }
}

// The mean over the pixels around that lie at about the same depth.
float Shader::Blurred(const std::vector<float>& values, int x, int y) const {
  constexpr int kReach = 3;
  const float depth = PixelDepth(x, y);
  const float near = 0.02f * size_;
  float sum = 0;
  int count = 0;
  for (int py = std::max(y - kReach, 0);
       py <= std::min(y + kReach, height_ - 1); ++py) {
    for (int px = std::max(x - kReach, 0);
         px <= std::min(x + kReach, width_ - 1); ++px) {
      if (!(std::abs(PixelDepth(px, py) - depth) < near)) continue;
      sum += values[size_t(py) * width_ + px];
      ++count;
    }
  }
  return sum / static_cast<float>(std::max(count, 1));
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
    } else if (segments_[other] != segments_[at]) {
      return 1;
    } else if (buffer_.depth[other] - buffer_.depth[at] > 0.05f * size_) {
      strength = std::max(strength, 0.6f);
    }
  }
  return strength;
}

Color Light(const Color& base, const Vector3f& n, float openness) {
  static const Vector3f to_light = Vector3f(-0.45f, 0.6f, 0.75f).normalized();
  static const Vector3f halfway = (to_light + Vector3f::UnitZ()).normalized();
  const Color sky(0.50f, 0.53f, 0.58f);
  const Color floor(0.30f, 0.27f, 0.25f);
  const float up = 0.5f + 0.5f * n.y();
  const Color ambient = openness * (up * sky + (1 - up) * floor);
  const float wrapped = std::max((n.dot(to_light) + 0.2f) / 1.2f, 0.0f);
  const Color key =
      wrapped * (0.4f + 0.6f * openness) * Color(0.78f, 0.75f, 0.70f);
  const float glance = std::max(n.dot(halfway), 0.0f);
  const float glance4 = glance * glance * glance * glance;
  const float glance8 = glance4 * glance4;
  const float shine = 0.10f * glance8 * glance8 * glance8 * openness;
  return base.cwiseProduct(ambient + key) + Color::Constant(shine);
}

std::pair<Color, float> Shader::Pixel(int x, int y) const {
  const float openness = openness_[size_t(y) * width_ + x];
  Color sum = Color::Zero();
  int covered = 0;
  for (int i = 0; i < kSupersampling * kSupersampling; ++i) {
    const int sx = x * kSupersampling + i % kSupersampling;
    const int sy = y * kSupersampling + i / kSupersampling;
    const size_t at = buffer_.At(sx, sy);
    if (buffer_.triangle[at] == kNoTriangle) continue;
    const Color& base = colors_[segments_[at]];
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
