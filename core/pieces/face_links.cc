#include "core/pieces/face_links.h"

#include <algorithm>
#include <set>

#include "core/pieces/region.h"

namespace marrow {

std::vector<std::array<uint32_t, 2>> TouchingFaces(const Adjacency& adjacency) {
  const std::vector<uint32_t> shell = ConnectedPieces(
      adjacency, std::vector<uint32_t>(adjacency.NumFaces(), 0));
  std::vector<std::array<uint32_t, 2>> touching;
  if (std::ranges::count(shell, 0u) == std::ssize(shell)) return touching;
  std::set<uint32_t> met;
  for (uint32_t v = 0; v < adjacency.NumVertices(); ++v) {
    met.clear();
    for (uint32_t f : adjacency.VertexFaces(v))
      if (met.insert(shell[f]).second && met.size() > 1)
        touching.push_back({adjacency.VertexFaces(v).front(), f});
  }
  return touching;
}

FaceLinks::FaceLinks(const Adjacency& adjacency,
                     std::span<const std::array<uint32_t, 2>> bridges) {
  std::vector<std::array<uint32_t, 2>> links = TouchingFaces(adjacency);
  for (const auto& [u, v] : bridges)
    links.push_back(
        {adjacency.VertexFaces(u).front(), adjacency.VertexFaces(v).front()});
  if (links.empty()) return;
  for (size_t i = 0, count = links.size(); i < count; ++i)
    links.push_back({links[i][1], links[i][0]});
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  offsets_.assign(adjacency.NumFaces() + 1, 0);
  for (const auto& [from, to] : links) {
    ++offsets_[from + 1];
    faces_.push_back(to);
  }
  for (size_t f = 1; f < offsets_.size(); ++f) offsets_[f] += offsets_[f - 1];
}

}  // namespace marrow
