#include "client/encoder/point_mesh.h"

#include <algorithm>
#include <bit>
#include <span>
#include <type_traits>

#include "absl/container/flat_hash_map.h"
#include "client/mesh_file/triangulate.h"

namespace marrow {
namespace {

template <typename T, size_t N>
DistinctRows<T, N> FindDistinct(const std::vector<std::array<T, N>>& input) {
  using Bits = std::conditional_t<sizeof(T) == 8, uint64_t, uint32_t>;
  DistinctRows<T, N> distinct;
  distinct.index.reserve(input.size());
  absl::flat_hash_map<std::array<Bits, N>, uint32_t> seen;
  seen.reserve(input.size());
  for (const std::array<T, N>& row : input) {
    const auto [entry, is_new] =
        seen.try_emplace(std::bit_cast<std::array<Bits, N>>(row),
                         static_cast<uint32_t>(distinct.rows.size()));
    if (is_new) distinct.rows.push_back(row);
    distinct.index.push_back(entry->second);
  }
  return distinct;
}

// Numbers points as they are first asked for.
class PointTable {
 public:
  explicit PointTable(PointMesh* mesh) : mesh_(*mesh) {}

  // A site, a row of uvs and a row of normals.
  uint32_t FindOrAdd(const Corners& key) {
    const auto [entry, is_new] = points_.try_emplace(
        key, static_cast<uint32_t>(mesh_.point_site.size()));
    if (is_new) {
      mesh_.point_site.push_back(key[0]);
      mesh_.point_uv.push_back(key[1]);
      mesh_.point_normal.push_back(key[2]);
    }
    return entry->second;
  }

 private:
  PointMesh& mesh_;
  absl::flat_hash_map<Corners, uint32_t> points_;
};

std::vector<bool> UsedSites(const PolygonMesh& mesh,
                            const CornerTriangles& triangles,
                            const DistinctRows<double, 3>& sites) {
  std::vector<bool> used(sites.rows.size(), false);
  for (const Corners& corners : triangles.corners) {
    for (const uint32_t corner : corners)
      used[sites.index[mesh.face_vertices[corner]]] = true;
  }
  return used;
}

// Renumbers: sites that are used come first, in their order, and only they keep
// their row.
void PutUsedFirst(const std::vector<bool>& used,
                  DistinctRows<double, 3>* sites) {
  std::vector<uint32_t> renumbered(used.size());
  uint32_t next = 0;
  for (const bool turn : {true, false}) {
    for (uint32_t s = 0; s < used.size(); ++s) {
      if (used[s] != turn) continue;
      if (turn) sites->rows[next] = sites->rows[s];
      renumbered[s] = next++;
    }
  }
  sites->rows.resize(
      static_cast<size_t>(std::count(used.begin(), used.end(), true)));
  for (uint32_t& site : sites->index) site = renumbered[site];
}

bool KeptByEdgebreaker(const Corners& sites) {
  return sites[0] != sites[1] && sites[1] != sites[2] && sites[2] != sites[0];
}

// Edgebreaker pairs the half-edges at a vertex by comparing all with all.
bool IsQuickForEdgebreaker(const std::vector<uint64_t>& degrees,
                           size_t num_triangles) {
  constexpr uint64_t kFixedComparisons = 100'000'000;
  constexpr uint64_t kComparisonsPerTriangle = 100;
  uint64_t comparisons = 0;
  for (const uint64_t degree : degrees) comparisons += degree * degree;
  return comparisons <=
         kFixedComparisons + kComparisonsPerTriangle * num_triangles;
}

}  // namespace

CornerTriangles TriangulateAll(const PolygonMesh& mesh) {
  // A stand-in whose "vertices" are the corners themselves.
  PolygonMesh face;
  std::vector<Corners> cut;
  CornerTriangles all;
  all.begin.reserve(mesh.NumFaces() + 1);
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    const std::span<const uint32_t> vertices = mesh.Face(f);
    const uint32_t first = mesh.face_offsets[f];
    if (vertices.size() == 3) {
      all.corners.push_back({first, first + 1, first + 2});
    } else if (vertices.size() > 3) {
      face.positions.clear();
      face.face_vertices.clear();
      for (const uint32_t v : vertices) {
        face.face_vertices.push_back(
            static_cast<uint32_t>(face.positions.size()));
        face.positions.push_back(mesh.positions[v]);
      }
      face.face_offsets = {0, static_cast<uint32_t>(vertices.size())};
      cut.clear();
      Triangulate(face, 0, &cut);
      for (const Corners& c : cut) {
        all.corners.push_back({first + c[0], first + c[1], first + c[2]});
      }
    }
    all.begin.push_back(static_cast<uint32_t>(all.corners.size()));
  }
  return all;
}

// Without attributes points are numbered as sites are, with them by corners.
PointMesh BuildPointMesh(const PolygonMesh& mesh,
                         const CornerTriangles& triangles,
                         bool keep_attributes) {
  PointMesh points;
  points.sites = FindDistinct(mesh.positions);
  PutUsedFirst(UsedSites(mesh, triangles, points.sites), &points.sites);
  const bool has_uvs = keep_attributes && !mesh.corner_uvs.empty();
  const bool has_normals = keep_attributes && !mesh.corner_normals.empty();
  if (has_uvs) points.uvs = FindDistinct(mesh.corner_uvs);
  if (has_normals) points.normals = FindDistinct(mesh.corner_normals);
  for (const Corners& triangle : triangles.corners) {
    Corners sites;
    for (int i = 0; i < 3; ++i) {
      sites[i] = points.sites.index[mesh.face_vertices[triangle[i]]];
    }
    points.site_corners.push_back(sites);
  }
  PointTable table(&points);
  if (!has_uvs && !has_normals) {
    for (uint32_t s = 0; s < points.sites.rows.size(); ++s)
      table.FindOrAdd({s, 0, 0});
  }
  for (size_t t = 0; t < triangles.corners.size(); ++t) {
    Corners corners;
    for (int i = 0; i < 3; ++i) {
      const uint32_t corner = triangles.corners[t][i];
      corners[i] = table.FindOrAdd(
          {points.site_corners[t][i], has_uvs ? points.uvs.index[corner] : 0,
           has_normals ? points.normals.index[corner] : 0});
    }
    points.faces.push_back(corners);
  }
  return points;
}

bool SuitsEdgebreaker(const PointMesh& points) {
  std::vector<uint64_t> degrees(points.sites.rows.size(), 0);
  for (const Corners& sites : points.site_corners) {
    if (!KeptByEdgebreaker(sites)) return false;
    for (const uint32_t site : sites) ++degrees[site];
  }
  return IsQuickForEdgebreaker(degrees, points.site_corners.size());
}

}  // namespace marrow
