#include "tests/testing/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <utility>

namespace marrow {
namespace {

using std::numbers::pi;
using Points = std::vector<Eigen::Vector3d>;

TriangleMesh MeshOf(const Points& points, std::vector<Triangle> faces) {
  TriangleMesh mesh;
  mesh.positions.resize(points.size(), 3);
  for (size_t v = 0; v < points.size(); ++v)
    mesh.positions.row(v) = points[v].transpose();
  mesh.faces = std::move(faces);
  return mesh;
}

Points PointsOf(const TriangleMesh& mesh) {
  Points points;
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
    points.push_back(mesh.Position(v));
  return points;
}

// Numbers the points of integer cells as they are met.
class LatticeNumbers {
 public:
  using Cell = std::array<int, 3>;

  uint32_t Of(const Cell& cell) {
    auto [it, is_new] = numbers_.try_emplace(cell, points_.size());
    if (is_new) points_.push_back(Eigen::Vector3d(cell[0], cell[1], cell[2]));
    return it->second;
  }
  const Points& points() const { return points_; }

 private:
  std::map<Cell, uint32_t> numbers_;
  Points points_;
};

// Moves every vertex half way to the mean of its neighbours, a few times.
void Round(TriangleMesh& mesh, int times) {
  for (int i = 0; i < times; ++i) {
    Positions sum = Positions::Zero(mesh.NumVertices(), 3);
    Eigen::VectorXd count = Eigen::VectorXd::Zero(mesh.NumVertices());
    for (const Triangle& face : mesh.faces)
      for (int c = 0; c < 3; ++c)
        for (uint32_t other : {face[(c + 1) % 3], face[(c + 2) % 3]}) {
          sum.row(face[c]) += mesh.positions.row(other);
          count[face[c]] += 1;
        }
    mesh.positions =
        0.5 * (mesh.positions + count.cwiseInverse().asDiagonal() * sum);
  }
}

// Turns points (x, distance from the axis) about x; the first and the last lie
// on the axis.
TriangleMesh Revolve(const std::vector<std::array<double, 2>>& profile,
                     uint32_t around) {
  const uint32_t rings = static_cast<uint32_t>(profile.size()) - 2;
  Points points = {{profile.front()[0], 0, 0}};
  for (uint32_t i = 1; i <= rings; ++i)
    for (uint32_t j = 0; j < around; ++j) {
      const double angle = 2 * pi * (j + 0.5 * (i % 2)) / around;
      points.emplace_back(profile[i][0], profile[i][1] * std::cos(angle),
                          profile[i][1] * std::sin(angle));
    }
  points.emplace_back(profile.back()[0], 0, 0);
  const uint32_t last = static_cast<uint32_t>(points.size()) - 1;
  auto at = [&](uint32_t ring, uint32_t j) {
    return 1 + ring * around + j % around;
  };
  std::vector<Triangle> faces;
  for (uint32_t j = 0; j < around; ++j) {
    faces.push_back({0, at(0, j + 1), at(0, j)});
    faces.push_back({last, at(rings - 1, j), at(rings - 1, j + 1)});
    for (uint32_t i = 0; i + 1 < rings; ++i) {
      // Rings alternate by half a step; ring i has the offset (i + 1) % 2.
      const uint32_t shift = (i + 1) % 2;
      faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j + shift)});
      faces.push_back({at(i, j + 1 - shift), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return MeshOf(points, std::move(faces));
}

}  // namespace

TriangleMesh SingleTriangle() {
  return MeshOf({{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}}, {{0, 1, 2}});
}

TriangleMesh Tetrahedron() {
  return MeshOf({{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}},
                {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

TriangleMesh Icosphere(uint32_t subdivisions) {
  const double g = std::numbers::phi;
  Points points = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                   {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                   {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (auto& p : points) p.normalize();
  std::vector<Triangle> faces = {
      {0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (uint32_t s = 0; s < subdivisions; ++s) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    auto middle = [&](uint32_t a, uint32_t b) {
      auto [it, is_new] = middles.try_emplace(std::minmax(a, b), points.size());
      if (is_new) points.push_back((points[a] + points[b]).normalized());
      return it->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : faces) {
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& t : {Triangle{a, ab, ca}, Triangle{b, bc, ab},
                                Triangle{c, ca, bc}, Triangle{ab, bc, ca}})
        finer.push_back(t);
    }
    faces = std::move(finer);
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh Torus(double big_radius, double small_radius, uint32_t around,
                   uint32_t across) {
  Points points;
  std::vector<Triangle> faces;
  for (uint32_t i = 0; i < around; ++i) {
    for (uint32_t j = 0; j < across; ++j) {
      const double u = 2 * pi * i / around, v = 2 * pi * j / across;
      const double w = big_radius + small_radius * std::cos(v);
      points.emplace_back(w * std::cos(u), w * std::sin(u),
                          small_radius * std::sin(v));
      const uint32_t next_i = (i + 1) % around, next_j = (j + 1) % across;
      const uint32_t a = i * across + j, b = next_i * across + j;
      const uint32_t c = next_i * across + next_j, d = i * across + next_j;
      faces.push_back({a, b, c});
      faces.push_back({a, c, d});
    }
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh Disk(uint32_t rings) {
  Points points = {{0, 0, 0}};
  std::vector<Triangle> faces;
  auto at = [](uint32_t ring, uint32_t k) {
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + k % (6 * ring);
  };
  for (uint32_t ring = 1; ring <= rings; ++ring) {
    for (uint32_t k = 0; k < 6 * ring; ++k) {
      const double angle = pi * k / (3 * ring);
      points.emplace_back(std::cos(angle) * ring / rings,
                          std::sin(angle) * ring / rings, 0);
    }
    for (uint32_t sector = 0; sector < 6; ++sector) {
      for (uint32_t j = 0; j < ring; ++j) {
        const uint32_t inner = at(ring - 1, sector * (ring - 1) + j);
        const uint32_t outer = at(ring, sector * ring + j + 1);
        faces.push_back({inner, at(ring, sector * ring + j), outer});
        if (j + 1 < ring)
          faces.push_back(
              {inner, outer, at(ring - 1, sector * (ring - 1) + j + 1)});
      }
    }
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh Grid(uint32_t columns, uint32_t rows) {
  Points points;
  std::vector<Triangle> faces;
  for (uint32_t x = 0; x <= columns; ++x)
    for (uint32_t y = 0; y <= rows; ++y) points.emplace_back(x, y, 0);
  for (uint32_t x = 0; x < columns; ++x)
    for (uint32_t y = 0; y < rows; ++y) {
      const uint32_t a = x * (rows + 1) + y, b = a + rows + 1;
      faces.push_back({a, b, b + 1});
      faces.push_back({a, b + 1, a + 1});
    }
  return MeshOf(points, std::move(faces));
}

TriangleMesh Dumbbell(double left, uint32_t around) {
  const double neck = 0.15;
  const double left_edge = std::sqrt(left * left - neck * neck);
  const double right_edge = std::sqrt(1 - neck * neck);
  const double length = 1.0;
  std::vector<std::array<double, 2>> profile;
  auto arc = [&](double centre, double radius, double from, double to) {
    const int steps = static_cast<int>(std::ceil(around * radius / 2));
    for (int i = 0; i <= steps; ++i) {
      const double angle = from + (to - from) * i / steps;
      profile.push_back(
          {centre - radius * std::cos(angle), radius * std::sin(angle)});
    }
  };
  const double left_end = pi - std::asin(neck / left);
  arc(-length / 2 - left_edge, left, 0, left_end);
  const int steps = static_cast<int>(around) / 3;
  for (int i = 1; i < steps; ++i)
    profile.push_back({length * (-0.5 + static_cast<double>(i) / steps), neck});
  arc(length / 2 + right_edge, 1, std::asin(neck), pi);
  return Revolve(profile, around);
}

TriangleMesh CubesSurface(const std::set<std::array<int, 3>>& cubes,
                          int fineness) {
  LatticeNumbers numbers;
  std::vector<Triangle> faces;
  for (const auto& cube : cubes) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int side : {0, 1}) {
        auto beyond = cube;
        beyond[axis] += side ? 1 : -1;
        if (cubes.count(beyond)) continue;
        const int u = (axis + 1) % 3, w = (axis + 2) % 3;
        auto corner = [&](int i, int j) {
          std::array<int, 3> at;
          at[axis] = (cube[axis] + side) * fineness;
          at[u] = cube[u] * fineness + i;
          at[w] = cube[w] * fineness + j;
          return numbers.Of(at);
        };
        for (int i = 0; i < fineness; ++i) {
          for (int j = 0; j < fineness; ++j) {
            std::array<uint32_t, 4> square = {corner(i, j), corner(i + 1, j),
                                              corner(i + 1, j + 1),
                                              corner(i, j + 1)};
            if (side == 0) std::reverse(square.begin(), square.end());
            faces.push_back({square[0], square[1], square[2]});
            faces.push_back({square[0], square[2], square[3]});
          }
        }
      }
    }
  }
  TriangleMesh mesh = MeshOf(numbers.points(), std::move(faces));
  mesh.positions /= fineness;
  return mesh;
}

TriangleMesh CubeShells(const std::set<std::array<int, 3>>& cubes,
                        int fineness) {
  std::vector<TriangleMesh> shells;
  for (const auto& cube : cubes)
    shells.push_back(CubesSurface({cube}, fineness));
  return Together(shells);
}

TriangleMesh TouchingGrids() {
  return Together({CubesSurface({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, 2),
                   CubesSurface({{1, 2, 0}, {2, 2, 0}, {3, 2, 0}}, 4),
                   CubesSurface({{-1, 2, 0}, {-2, 2, 0}, {-3, 2, 0}}, 4)});
}

TriangleMesh LimbCross(uint32_t fineness) {
  std::set<std::array<int, 3>> cubes;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) cubes.insert({x, y, z});
  for (int i = 2; i <= 5; ++i) cubes.insert({i, 0, 0});
  for (int i = 2; i <= 6; ++i) cubes.insert({-i, 0, 0});
  for (int i = 2; i <= 7; ++i) cubes.insert({0, i, 0});
  for (int i = 2; i <= 8; ++i) cubes.insert({0, 0, i});
  TriangleMesh mesh = CubesSurface(cubes, static_cast<int>(fineness));
  Round(mesh, 4);
  return mesh;
}

TriangleMesh Book(uint32_t pages, uint32_t rows) {
  Points points;
  std::vector<Triangle> faces;
  for (uint32_t y = 0; y <= rows; ++y) points.emplace_back(0, 0, y);
  for (uint32_t page = 0; page < pages; ++page) {
    const double angle = 2 * pi * page / pages;
    const uint32_t first = static_cast<uint32_t>(points.size());
    for (uint32_t y = 0; y <= rows; ++y)
      points.emplace_back(std::cos(angle), std::sin(angle), y);
    for (uint32_t y = 0; y < rows; ++y) {
      faces.push_back({y, first + y, first + y + 1});
      faces.push_back({y, first + y + 1, y + 1});
    }
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh Bowtie(uint32_t rings) {
  const TriangleMesh disk = Disk(rings);
  Points points = PointsOf(disk);
  std::vector<Triangle> faces = disk.faces;
  // The second disk is the first, turned about the rim vertex it shares.
  const uint32_t n = disk.NumVertices(), shared = n - 6 * rings;
  const Eigen::Vector3d tip = points[shared];
  std::vector<uint32_t> number(n);
  for (uint32_t v = 0; v < n; ++v) {
    number[v] = v == shared ? v : static_cast<uint32_t>(points.size());
    if (v != shared) points.push_back(2 * tip - points[v]);
  }
  for (const Triangle& f : disk.faces)
    faces.push_back({number[f[0]], number[f[1]], number[f[2]]});
  return MeshOf(points, std::move(faces));
}

TriangleMesh Moebius(uint32_t columns) {
  Points points;
  std::vector<Triangle> faces;
  for (uint32_t i = 0; i < columns; ++i) {
    const double turn = pi * i / columns;
    for (int j = -1; j <= 1; ++j) {
      const double out = 1 + 0.3 * j * std::cos(turn);
      points.push_back({out * std::cos(2 * turn), out * std::sin(2 * turn),
                        0.3 * j * std::sin(turn)});
    }
    const auto next = [&](uint32_t j) {
      return i + 1 < columns ? 3 * (i + 1) + j : 2 - j;
    };
    for (uint32_t j = 0; j < 2; ++j) {
      faces.push_back({3 * i + j, next(j), next(j + 1)});
      faces.push_back({3 * i + j, next(j + 1), 3 * i + j + 1});
    }
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh Together(const std::vector<TriangleMesh>& meshes) {
  Points points;
  std::vector<Triangle> faces;
  for (const TriangleMesh& mesh : meshes) {
    const auto n = static_cast<uint32_t>(points.size());
    for (const Eigen::Vector3d& p : PointsOf(mesh)) points.push_back(p);
    for (const Triangle& f : mesh.faces)
      faces.push_back({n + f[0], n + f[1], n + f[2]});
  }
  return MeshOf(points, std::move(faces));
}

TriangleMesh Apart(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh moved = b;
  moved.positions.col(0).array() +=
      1 + a.positions.col(0).maxCoeff() - b.positions.col(0).minCoeff();
  return Together({a, moved});
}

TriangleMesh WithSlivers(const TriangleMesh& mesh, uint32_t step,
                         double height) {
  Points points = PointsOf(mesh);
  std::vector<Triangle> faces;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    const auto [a, b, c] = mesh.faces[f];
    if (f % step != 0) {
      faces.push_back(mesh.faces[f]);
      continue;
    }
    const uint32_t p = static_cast<uint32_t>(points.size());
    points.push_back((1 - height) * 0.5 * (points[a] + points[b]) +
                     height * points[c]);
    faces.push_back({a, b, p});
    faces.push_back({b, c, p});
    faces.push_back({c, a, p});
  }
  return MeshOf(points, std::move(faces));
}

std::string TestNameOf(const NamedMesh& shape) {
  std::string name = shape.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

std::vector<NamedMesh> AllShapes() {
  return {
      {"triangle", SingleTriangle()},
      {"tetrahedron", Tetrahedron()},
      {"sphere", Icosphere(2)},
      {"torus", Torus(2, 0.7, 24, 10)},
      {"disk", Disk(8)},
      {"strip", Grid(60, 2)},
      {"dumbbell", Dumbbell(0.8, 14)},
      {"cross", LimbCross(2)},
      {"book", Book(5, 20)},
      {"bowtie", Bowtie(5)},
      {"two spheres", Apart(Icosphere(2), Icosphere(1))},
      {"three bodies", Apart(Apart(Disk(4), Tetrahedron()), LimbCross(1))},
      {"needles", WithSlivers(Icosphere(2), 3, 1e-9)},
      {"zero areas", WithSlivers(Grid(12, 8), 5, 0)},
  };
}

Renumbering Renumber(const TriangleMesh& mesh, uint32_t seed) {
  // Standard engines are the same everywhere; standard shuffles are not.
  std::mt19937 random(seed);
  auto shuffled = [&](uint32_t n) {
    std::vector<uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0u);
    for (uint32_t i = n; i > 1; --i)
      std::swap(order[i - 1], order[random() % i]);
    return order;
  };
  Renumbering result;
  result.old_vertex = shuffled(mesh.NumVertices());
  result.old_face = shuffled(mesh.NumFaces());
  std::vector<uint32_t> new_vertex(mesh.NumVertices());
  result.mesh.positions.resize(mesh.NumVertices(), 3);
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    new_vertex[result.old_vertex[v]] = v;
    result.mesh.positions.row(v) = mesh.positions.row(result.old_vertex[v]);
  }
  for (uint32_t f : result.old_face) {
    const Triangle& old = mesh.faces[f];
    Triangle face = {new_vertex[old[0]], new_vertex[old[1]],
                     new_vertex[old[2]]};
    std::rotate(face.begin(), face.begin() + random() % 3, face.end());
    result.mesh.faces.push_back(face);
  }
  return result;
}

TriangleMesh Rotated(const TriangleMesh& mesh, const Eigen::Vector3d& axis,
                     double radians) {
  TriangleMesh result = mesh;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(radians, axis.normalized()).toRotationMatrix();
  result.positions = mesh.positions * turn.transpose();
  return result;
}

TriangleMesh Scaled(const TriangleMesh& mesh, double factor) {
  TriangleMesh result = mesh;
  result.positions *= factor;
  return result;
}

TriangleMesh Rounded(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  result.positions = mesh.positions.cast<float>().cast<double>();
  return result;
}

CanonicalMesh CanonicalOf(const TriangleMesh& mesh) {
  return Canonicalize({mesh.positions, mesh.faces}).value();
}

}  // namespace marrow
