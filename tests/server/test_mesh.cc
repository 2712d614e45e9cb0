#include "tests/server/test_mesh.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace marrow::testing {
namespace {

using Corner = Eigen::Vector3d;
using Soup = std::vector<std::array<Corner, 3>>;

Soup Icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::vector<Corner> p = {{-1, g, 0},  {1, g, 0},   {-1, -g, 0},
                                 {1, -g, 0},  {0, -1, g},  {0, 1, g},
                                 {0, -1, -g}, {0, 1, -g},  {g, 0, -1},
                                 {g, 0, 1},   {-g, 0, -1}, {-g, 0, 1}};
  const int f[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10},
                        {0, 10, 11}, {1, 5, 9},  {5, 11, 4}, {11, 10, 2},
                        {10, 7, 6},  {7, 1, 8},  {3, 9, 4},  {3, 4, 2},
                        {3, 2, 6},   {3, 6, 8},  {3, 8, 9},  {4, 9, 5},
                        {2, 4, 11},  {6, 2, 10}, {8, 6, 7},  {9, 8, 1}};
  Soup soup;
  for (const auto& t : f) soup.push_back({p[t[0]], p[t[1]], p[t[2]]});
  return soup;
}

Soup Subdivide(const Soup& soup) {
  Soup finer;
  for (const auto& [a, b, c] : soup) {
    const Corner ab = (a + b) / 2;
    const Corner bc = (b + c) / 2;
    const Corner ca = (c + a) / 2;
    finer.push_back({a, ab, ca});
    finer.push_back({b, bc, ab});
    finer.push_back({c, ca, bc});
    finer.push_back({ab, bc, ca});
  }
  return finer;
}

Corner OnStar(const Corner& p, double stretch) {
  const Corner d = p.normalized();
  const std::vector<Corner> arms = {{1, 0, 0.1},
                                    {-0.6, 0.8, 0},
                                    {-0.6, -0.8, 0.1},
                                    {0, 0.1, 1},
                                    {0.3, 0, -1}};
  double radius = 1;
  for (const Corner& arm : arms) {
    const double cosine = d.dot(arm.normalized());
    radius += 2.5 * std::exp((cosine - 1) / 0.02);
  }
  return Corner(radius * d.x() * stretch, radius * d.y(), radius * d.z());
}

}  // namespace

std::string StarPayload(int depth, double stretch) {
  Soup soup = Icosahedron();
  for (int i = 0; i < depth; ++i) soup = Subdivide(soup);
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(soup.size()));
  const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION,
                                             3, draco::DT_FLOAT32);
  for (size_t i = 0; i < soup.size(); ++i) {
    std::array<Eigen::Vector3f, 3> corners;
    for (int k = 0; k < 3; ++k) {
      corners[k] = OnStar(soup[i][k], stretch).cast<float>();
    }
    builder.SetAttributeValuesForFace(
        attribute, draco::FaceIndex(static_cast<uint32_t>(i)),
        corners[0].data(), corners[1].data(), corners[2].data());
  }
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) return "";
  return std::string(buffer.data(), buffer.size());
}

}  // namespace marrow::testing
