#include "core/boundaries/piece_graph.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/pieces/region.h"

namespace marrow {

PieceGraph::PieceGraph(const Adjacency& adjacency,
                       std::vector<uint32_t> piece_of_face,
                       const std::vector<double>& face_areas,
                       const FaceLinks& links)
    : group_of_face_(std::move(piece_of_face)) {
  const uint32_t count =
      *std::max_element(group_of_face_.begin(), group_of_face_.end()) + 1;
  faces_.resize(count);
  areas_.resize(count);
  for (uint32_t f = 0; f < group_of_face_.size(); ++f) {
    faces_[group_of_face_[f]].push_back(f);
    areas_[group_of_face_[f]] += face_areas[f];
  }
  std::vector<uint32_t> around;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    around.clear();
    for (uint32_t f : adjacency.EdgeFaces(e))
      around.push_back(group_of_face_[f]);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    for (size_t i = 0; i < around.size(); ++i)
      for (size_t j = i + 1; j < around.size(); ++j)
        boundaries_[{around[i], around[j]}].push_back(e);
  }
  for (uint32_t f = 0; !links.empty() && f < group_of_face_.size(); ++f)
    for (uint32_t g : links.Of(f))
      if (group_of_face_[f] < group_of_face_[g])
        boundaries_.try_emplace({group_of_face_[f], group_of_face_[g]});
  neighbours_.resize(count);
  for (const auto& [pair, edges] : boundaries_) {
    neighbours_[pair.first].insert(pair.second);
    neighbours_[pair.second].insert(pair.first);
  }
  if (!links.empty()) FindShells(adjacency, face_areas);
}

void PieceGraph::FindShells(const Adjacency& adjacency,
                            const std::vector<double>& face_areas) {
  const std::vector<uint32_t> shell = ConnectedPieces(
      adjacency, std::vector<uint32_t>(group_of_face_.size(), 0));
  shell_areas_.resize(*std::max_element(shell.begin(), shell.end()) + 1);
  for (uint32_t f = 0; f < shell.size(); ++f)
    shell_areas_[shell[f]] += face_areas[f];
  for (const auto& faces : faces_) {
    std::set<uint32_t>& own = shells_.emplace_back();
    for (uint32_t f : faces) own.insert(shell[f]);
    double& area = areas_of_shells_.emplace_back(0);
    for (uint32_t s : own) area += shell_areas_[s];
  }
}

void PieceGraph::SetFirstSplit(const std::vector<uint32_t>& segment_of_face,
                               const std::vector<double>& face_areas) {
  split_areas_.resize(areas_.size());
  for (uint32_t f = 0; f < segment_of_face.size(); ++f)
    split_areas_[group_of_face_[f]][segment_of_face[f]] += face_areas[f];
}

double PieceGraph::ApartInFirstSplit(const Pair& groups) const {
  const auto [a, b] = groups;
  if (split_areas_.empty() || !(areas_[a] > 0 && areas_[b] > 0)) return 0;
  double together = 0;
  for (const auto& [segment, area] : split_areas_[a]) {
    const auto other = split_areas_[b].find(segment);
    if (other != split_areas_[b].end())
      together += std::min(area / areas_[a], other->second / areas_[b]);
  }
  return std::max(0.0, 1 - together);
}

double PieceGraph::AreaOfShells(uint32_t group) const {
  return shells_.empty() ? areas_[group] : areas_of_shells_[group];
}

std::vector<uint32_t> PieceGraph::Groups() const {
  std::vector<uint32_t> groups;
  for (uint32_t g = 0; g < faces_.size(); ++g)
    if (!faces_[g].empty()) groups.push_back(g);
  return groups;
}

void PieceGraph::Merge(uint32_t a, uint32_t b) {
  for (uint32_t f : faces_[b]) group_of_face_[f] = a;
  faces_[a].insert(faces_[a].end(), faces_[b].begin(), faces_[b].end());
  faces_[b] = {};
  areas_[a] += areas_[b];
  areas_[b] = 0;
  if (!shells_.empty()) {
    for (uint32_t shell : shells_[b])
      if (shells_[a].insert(shell).second)
        areas_of_shells_[a] += shell_areas_[shell];
    shells_[b] = {};
  }
  if (!split_areas_.empty())
    for (const auto& [segment, area] : std::exchange(split_areas_[b], {}))
      split_areas_[a][segment] += area;
  MergeBoundaries(a, b);
}

void PieceGraph::MergeBoundaries(uint32_t a, uint32_t b) {
  boundaries_.erase({a, b});
  neighbours_[a].erase(b);
  for (uint32_t other : std::exchange(neighbours_[b], {})) {
    if (other == a) continue;
    neighbours_[other].erase(b);
    neighbours_[other].insert(a);
    neighbours_[a].insert(other);
    const Boundary edges =
        std::move(boundaries_.extract(std::minmax(b, other)).mapped());
    Boundary& boundary = boundaries_[std::minmax(a, other)];
    Boundary joined;
    std::set_union(boundary.begin(), boundary.end(), edges.begin(), edges.end(),
                   std::back_inserter(joined));
    boundary = std::move(joined);
  }
}

}  // namespace marrow
