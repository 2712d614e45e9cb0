#include "core/pieces/region.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/disjoint_sets.h"

namespace marrow {
namespace {

std::vector<Triangle> LocalTriangles(const TriangleMesh& mesh,
                                     const std::vector<uint32_t>& faces,
                                     const RankedSet& vertices) {
  std::vector<Triangle> triangles(faces.size());
  for (size_t f = 0; f < faces.size(); ++f)
    for (int i = 0; i < 3; ++i)
      triangles[f][i] = vertices.RankOf(mesh.faces[faces[f]][i]);
  return triangles;
}

// That of the mesh where the region is all of it.
Adjacency LocalAdjacency(const Adjacency& adjacency, uint32_t num_vertices,
                         const std::vector<Triangle>& triangles) {
  if (num_vertices == adjacency.NumVertices() &&
      triangles.size() == adjacency.NumFaces())
    return adjacency;
  TriangleMesh topology;
  topology.positions.resize(num_vertices, 3);
  topology.faces = triangles;
  return Adjacency(topology);
}

std::vector<std::array<uint32_t, 3>> FacesAcross(const Adjacency& adjacency) {
  std::vector<std::array<uint32_t, 3>> across(adjacency.NumFaces());
  for (uint32_t f = 0; f < across.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      const auto faces = adjacency.EdgeFaces(adjacency.FaceEdges(f)[i]);
      across[f][i] = faces.size() == 2 ? faces[faces[0] == f] : kNoIndex;
    }
  return across;
}

std::vector<std::array<uint32_t, 2>> LocalLinks(
    const std::vector<uint32_t>& faces, const FaceLinks& links) {
  std::vector<std::array<uint32_t, 2>> local;
  if (links.empty()) return local;
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (uint32_t there : links.Of(faces[f])) {
      const auto it = std::lower_bound(faces.begin(), faces.end(), there);
      if (it != faces.end() && *it == there)
        local.push_back({f, static_cast<uint32_t>(it - faces.begin())});
    }
  return local;
}

}  // namespace

Region::Region(const TriangleMesh& mesh, const Adjacency& adjacency,
               const std::vector<double>& face_areas,
               const std::vector<uint32_t>& faces, const FaceLinks& links)
    : Region(mesh, adjacency, face_areas, faces, links,
             RankedSet(mesh.faces, faces)) {}

Region::Region(const TriangleMesh& mesh, const Adjacency& adjacency,
               const std::vector<double>& face_areas,
               const std::vector<uint32_t>& faces, const FaceLinks& links,
               const RankedSet& vertices)
    : faces_(faces),
      vertices_(vertices.Members()),
      triangles_(LocalTriangles(mesh, faces, vertices)),
      local_(LocalAdjacency(adjacency, NumVertices(), triangles_)),
      across_(FacesAcross(local_)),
      loop_(NumVertices(), kNoIndex) {
  areas_.reserve(faces.size());
  for (uint32_t f : faces) areas_.push_back(face_areas[f]);
  area_ = std::accumulate(areas_.begin(), areas_.end(), 0.0);

  DisjointSets loops(NumVertices());
  for (uint32_t f = 0; f < NumFaces(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t here = local_.FaceEdges(f)[i];
      const uint32_t there = adjacency.FaceEdges(faces_[f])[i];
      if (adjacency.EdgeFaces(there).size() == local_.EdgeFaces(here).size())
        continue;
      const auto [a, b] = local_.EdgeVertices(here);
      loops.Union(a, b);
      loop_[a] = a;
      loop_[b] = b;
    }
  }
  for (uint32_t& loop : loop_)
    if (loop != kNoIndex) loop = loops.Find(loop);
  links_ = LocalLinks(faces_, links);
}

std::span<const std::array<uint32_t, 2>> Region::LinksOf(uint32_t f) const {
  if (links_.empty()) return {};
  const auto begin = std::lower_bound(links_.begin(), links_.end(),
                                      std::array<uint32_t, 2>{f, 0});
  auto end = begin;
  while (end != links_.end() && (*end)[0] == f) ++end;
  return {begin, end};
}

std::vector<uint32_t> Region::BoundaryLoop(uint32_t v) const {
  if (loop_[v] == kNoIndex) return {v};
  std::vector<uint32_t> members;
  for (uint32_t u = 0; u < NumVertices(); ++u)
    if (loop_[u] == loop_[v]) members.push_back(u);
  return members;
}

std::vector<uint32_t> Region::AllFaces() const {
  std::vector<uint32_t> all(NumFaces());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

std::vector<uint32_t> ConnectedPieces(
    const Adjacency& adjacency, const std::vector<uint32_t>& labels,
    std::span<const std::array<uint32_t, 2>> links) {
  DisjointSets sets(adjacency.NumFaces());
  std::vector<std::pair<uint32_t, uint32_t>> around;  // label, face
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    const std::span<const uint32_t> faces = adjacency.EdgeFaces(e);
    if (faces.size() == 2) {
      if (labels[faces[0]] == labels[faces[1]]) sets.Union(faces[0], faces[1]);
      continue;
    }
    around.clear();
    for (uint32_t f : faces) around.push_back({labels[f], f});
    std::sort(around.begin(), around.end());
    for (size_t i = 1; i < around.size(); ++i)
      if (around[i].first == around[i - 1].first)
        sets.Union(around[i].second, around[i - 1].second);
  }
  for (const auto& [f, g] : links)
    if (labels[f] == labels[g]) sets.Union(f, g);
  std::vector<uint32_t> piece(adjacency.NumFaces());
  uint32_t count = 0;
  for (uint32_t f = 0; f < piece.size(); ++f)
    piece[f] = sets.Find(f) == f ? count++ : piece[sets.Find(f)];
  return piece;
}

}  // namespace marrow
