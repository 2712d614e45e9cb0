#include "core/pieces/face_links.h"

#include <algorithm>

namespace marrow {

FaceLinks::FaceLinks(const Adjacency& adjacency,
                     std::span<const std::array<uint32_t, 2>> bridges) {
  if (bridges.empty()) return;
  std::vector<std::array<uint32_t, 2>> links;
  for (const auto& [u, v] : bridges) {
    const uint32_t f = adjacency.VertexFaces(u).front();
    const uint32_t g = adjacency.VertexFaces(v).front();
    links.push_back({f, g});
    links.push_back({g, f});
  }
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
