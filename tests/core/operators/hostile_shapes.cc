#include "tests/core/operators/hostile_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace marrow {
namespace {

using std::numbers::pi;
using Points = std::vector<Eigen::Vector3d>;

TriangleMesh MeshOf(const Points& points, std::vector<Triangle> faces) {
  TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (size_t v = 0; v < points.size(); ++v)
    mesh.positions.row(static_cast<Eigen::Index>(v)) = points[v].transpose();
  mesh.faces = std::move(faces);
  return mesh;
}

Points PointsOf(const TriangleMesh& mesh) {
  Points points;
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
    points.push_back(mesh.Position(v));
  return points;
}

Eigen::Vector3d OnCircle(double turns) {
  return {std::cos(2 * pi * turns), std::sin(2 * pi * turns), 0};
}

// A grid of `across` + 1 vertices by `around` columns whose last column is
// glued to the first through `Glue`, which names the row that it meets.
template <typename Glue>
std::vector<Triangle> Band(uint32_t around, uint32_t across, uint32_t rows,
                           const Glue& glue) {
  auto at = [&](uint32_t i, uint32_t j) {
    return i < around ? i * rows + j % rows : glue(j) % rows;
  };
  std::vector<Triangle> faces;
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < across; ++j) {
      faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return faces;
}

}  // namespace

TriangleMesh AllSlivers(const TriangleMesh& mesh, double angle) {
  Points points = PointsOf(mesh);
  std::vector<Triangle> faces;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const auto [a, b, c] = mesh.faces[f];
    const double share = static_cast<double>(f % 97) / 96;
    const double near = 0.01 * std::pow(100 * angle, share);
    const Eigen::Vector3d to =
        f % 2 ? points[a] : Eigen::Vector3d(0.5 * (points[a] + points[b]));
    const Eigen::Vector3d from =
        f % 2 ? Eigen::Vector3d(0.5 * (points[b] + points[c])) : points[c];
    const uint32_t p = static_cast<uint32_t>(points.size());
    points.push_back(to + near * (from - to));
    for (const Triangle& face :
         {Triangle{a, b, p}, Triangle{b, c, p}, Triangle{c, a, p}})
      faces.push_back(face);
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh RandomObtuse(uint32_t points, bool closed, uint32_t seed) {
  std::mt19937 random(seed);
  TriangleMesh mesh = MeshOf(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      closed ? std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {3, 2, 1}}
             : std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  Points all = PointsOf(mesh);
  while (all.size() < points) {
    const uint32_t f = static_cast<uint32_t>(random() % mesh.faces.size());
    const auto [a, b, c] = mesh.faces[f];
    const double u = random() * 0x1p-32, v = (1 - u) * (random() * 0x1p-32);
    const uint32_t p = static_cast<uint32_t>(all.size());
    all.push_back(u * all[a] + v * all[b] + (1 - u - v) * all[c]);
    mesh.faces[f] = {a, b, p};
    mesh.faces.push_back({b, c, p});
    mesh.faces.push_back({c, a, p});
  }
  return MeshOf(all, std::move(mesh.faces));
}

TriangleMesh KleinBottle(uint32_t around, uint32_t across) {
  Points points;
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < across; ++j) {
      const double turn = static_cast<double>(i) / around;
      const double u = pi * turn, v = 2 * pi * (j + 0.5) / across;
      const double x = std::sin(v), y = std::sin(2 * v);
      points.push_back(
          (2.5 + std::cos(u) * x - std::sin(u) * y) * OnCircle(turn) +
          Eigen::Vector3d(0, 0, std::sin(u) * x + std::cos(u) * y));
    }
  // Half a turn of the figure 8 takes angle v to -v.
  return MeshOf(points, Band(around, across, across,
                             [&](uint32_t j) { return 2 * across - 1 - j; }));
}

TriangleMesh Pages(uint32_t pages) {
  Points points = {{0, 0, -0.5}, {0, 0, 0.5}};
  std::vector<Triangle> faces;
  for (uint32_t page = 0; page < pages; ++page) {
    points.push_back(OnCircle(static_cast<double>(page) / pages));
    // Wide pages are obtuse at the spine's opposite corner, narrow are not.
    points.back() *= page % 2 ? 0.2 : 1.0;
    faces.push_back({0, 1, page + 2});
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh TurnedOver(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  for (uint32_t f = 0; f < result.NumFaces(); f += 2)
    std::swap(result.faces[f][1], result.faces[f][2]);
  return result;
}

TriangleMesh Doubled(const TriangleMesh& mesh, uint32_t step) {
  TriangleMesh result = mesh;
  for (uint32_t f = 0; f < mesh.NumFaces(); f += step) {
    const auto [a, b, c] = mesh.faces[f];
    result.faces.push_back({a, c, b});
  }
  return result;
}

TriangleMesh Cascade(double ratio) {
  Points points = {{0, 0, 0}, {0.3, 1, 0}};
  for (double x = 1; x > 1e-12; x /= ratio) points.push_back({x, 0, 0});
  const uint32_t n = static_cast<uint32_t>(points.size());
  std::vector<Triangle> faces = {{0, n - 1, 1}};
  for (uint32_t v = 2; v + 1 < n; ++v) faces.push_back({v + 1, v, 1});
  // A flat fan below the edge.
  for (uint32_t v = 2; v + 1 < n; ++v) faces.push_back({0, v, v + 1});
  return MeshOf(points, std::move(faces));
}

TriangleMesh Fan(uint32_t triangles, double shift) {
  Points points = {{shift, 0, 0}};
  std::vector<Triangle> faces;
  for (uint32_t i = 0; i < triangles; ++i) {
    points.push_back(OnCircle((i + 0.5) / triangles));
    faces.push_back({0, 1 + i, 1 + (i + 1) % triangles});
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh Bipyramid(uint32_t triangles) {
  Points points = {{0, 0, 1}, {0, 0, -1}};
  std::vector<Triangle> faces;
  for (uint32_t i = 0; i < triangles; ++i) {
    points.push_back(OnCircle(static_cast<double>(i) / triangles));
    const uint32_t a = 2 + i, b = 2 + (i + 1) % triangles;
    faces.push_back({0, a, b});
    faces.push_back({1, b, a});
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh Cones(uint32_t cones, uint32_t around) {
  Points points = {{0, 0, 0}};
  std::vector<Triangle> faces;
  for (uint32_t cone = 0; cone < cones; ++cone) {
    const uint32_t first = static_cast<uint32_t>(points.size());
    for (uint32_t i = 0; i < around; ++i) {
      points.push_back((1 + cone) *
                       (Eigen::Vector3d(0, 0, 1) +
                        OnCircle(static_cast<double>(i) / around)));
      faces.push_back({0, first + i, first + (i + 1) % around});
    }
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh TwistedCan(uint32_t around, double turns) {
  Points points = {{0, 0, 0}, {0, 0, 3}};
  std::vector<Triangle> faces;
  for (uint32_t i = 0; i < around; ++i) {
    points.push_back(OnCircle(static_cast<double>(i) / around));
    points.push_back(OnCircle(turns + static_cast<double>(i) / around) +
                     Eigen::Vector3d(0, 0, 3));
    const uint32_t a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % around);
    for (const Triangle& face :
         {Triangle{0, b, a}, Triangle{1, a + 1, b + 1}, Triangle{a, b, b + 1},
          Triangle{a, b + 1, a + 1}})
      faces.push_back(face);
  }
  return MeshOf(points, std::move(faces));
}

std::vector<NamedMesh> HostileShapes() {
  return {
      {"sliver_sphere", AllSlivers(Icosphere(2), 1e-6)},
      {"sliver_sphere_twice", AllSlivers(AllSlivers(Icosphere(1), 1e-3), 1e-6)},
      {"thinnest_slivers", AllSlivers(Icosphere(2), 1e-12)},
      {"sliver_disk", AllSlivers(Disk(6), 1e-6)},
      {"obtuse_square", RandomObtuse(400, false, 1)},
      {"obtuse_pillow", RandomObtuse(400, true, 2)},
      {"moebius", Moebius(20)},
      {"sliver_moebius", AllSlivers(Moebius(20), 1e-6)},
      {"klein", KleinBottle(24, 16)},
      {"sliver_klein", AllSlivers(KleinBottle(24, 16), 1e-6)},
      {"three_pages", Pages(3)},
      {"thousand_pages", Pages(1000)},
      {"sliver_book", AllSlivers(Book(5, 6), 1e-6)},
      {"sliver_bowtie", AllSlivers(Bowtie(4), 1e-6)},
      {"random_sides", TurnedOver(RandomObtuse(300, true, 3))},
      {"twins", Doubled(Icosphere(2), 3)},
      {"sliver_twins", Doubled(AllSlivers(Icosphere(2), 1e-6), 2)},
      {"zero_area_sphere", WithSlivers(Icosphere(2), 2, 0)},
      {"zero_area_torus", WithSlivers(Torus(2, 0.7, 20, 10), 1, 0)},
      {"cascade", Cascade(10)},
      {"steep_cascade", Cascade(1e6)},
      {"fine_cascade", Cascade(1.5)},
      {"fan", Fan(500, 0)},
      {"eccentric_fan", Fan(500, 0.9)},
      {"rim_fan", Fan(500, 1 - 1e-9)},
      {"bipyramid", Bipyramid(500)},
      {"cones", Cones(20, 12)},
      {"can", TwistedCan(60, 0.05)},
      {"twisted_can", TwistedCan(60, 0.3)},
      {"sliver_bodies", AllSlivers(Apart(Disk(4), Icosphere(1)), 1e-6)},
  };
}

}  // namespace marrow
