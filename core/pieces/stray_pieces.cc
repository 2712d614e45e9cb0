#include "core/pieces/stray_pieces.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/mesh/triangle_mesh.h"
#include "core/pieces/region.h"

namespace marrow {
namespace {

// Connected pieces of faces with one label: piece of each face, and its label.
struct LabelPieces {
  std::vector<uint32_t> piece;
  std::vector<uint32_t> label;
  std::vector<double> area;
};

LabelPieces FindLabelPieces(const Adjacency& adjacency,
                            const std::vector<double>& face_areas,
                            std::span<const std::array<uint32_t, 2>> links,
                            const std::vector<uint32_t>& labels) {
  LabelPieces result;
  result.piece = ConnectedPieces(adjacency, labels, links);
  for (uint32_t f = 0; f < labels.size(); ++f) {
    if (result.piece[f] == result.label.size()) {
      result.label.push_back(labels[f]);
      result.area.push_back(0);
    }
    result.area[result.piece[f]] += face_areas[f];
  }
  return result;
}

// For each piece, the label with which it shares the longest boundary, counted
// in edges and links; its own where it touches no other. Only pieces that stay
// count as neighbours, so that every move ends in one.
class LongestNeighbour {
 public:
  LongestNeighbour(const LabelPieces& pieces, const std::vector<bool>& is_main)
      : pieces_(pieces), is_main_(is_main) {}

  // The faces of one edge or link. Strays and main pieces are told apart
  // first: where a thousand pages meet, there are few main pieces.
  void Meet(std::span<const uint32_t> faces) {
    strays_.clear();
    mains_.clear();
    for (uint32_t f : faces) {
      const uint32_t piece = pieces_.piece[f];
      (is_main_[piece] ? mains_ : strays_).push_back(piece);
    }
    if (strays_.empty() || mains_.empty()) return;
    for (std::vector<uint32_t>* list : {&strays_, &mains_}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    for (uint32_t stray : strays_)
      for (uint32_t main : mains_) ++shared_[{stray, pieces_.label[main]}];
  }

  std::vector<uint32_t> Labels() const {
    std::vector<uint32_t> result = pieces_.label, longest(result.size(), 0);
    for (const auto& [key, count] : shared_)
      if (count > longest[key.first]) {
        longest[key.first] = count;
        result[key.first] = key.second;
      }
    return result;
  }

 private:
  const LabelPieces& pieces_;
  const std::vector<bool>& is_main_;
  std::vector<uint32_t> strays_, mains_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> shared_;
};

}  // namespace

void JoinStrayPieces(const Adjacency& adjacency,
                     const std::vector<double>& face_areas,
                     std::span<const std::array<uint32_t, 2>> links,
                     size_t num_labels, std::vector<uint32_t>& labels,
                     double most) {
  // A stray that touches only strays is reached once they have moved.
  for (int round = 0; round < 8; ++round) {
    const LabelPieces pieces =
        FindLabelPieces(adjacency, face_areas, links, labels);
    std::vector<uint32_t> main(num_labels, kNoIndex);
    for (uint32_t p = 0; p < pieces.label.size(); ++p) {
      uint32_t& best = main[pieces.label[p]];
      if (best == kNoIndex || pieces.area[p] > pieces.area[best]) best = p;
    }
    std::vector<bool> is_main(pieces.label.size(), false);
    for (uint32_t p = 0; p < pieces.label.size(); ++p) {
      const uint32_t largest = main[pieces.label[p]];
      is_main[p] = p == largest || pieces.area[p] > most * pieces.area[largest];
    }
    if (std::ranges::find(is_main, false) == is_main.end()) return;
    LongestNeighbour neighbours(pieces, is_main);
    for (uint32_t e = 0; e < adjacency.NumEdges(); ++e)
      neighbours.Meet(adjacency.EdgeFaces(e));
    for (const auto& link : links) neighbours.Meet(link);
    const std::vector<uint32_t> target = neighbours.Labels();
    bool moved = false;
    for (uint32_t f = 0; f < labels.size(); ++f) {
      moved |= labels[f] != target[pieces.piece[f]];
      labels[f] = target[pieces.piece[f]];
    }
    if (!moved) return;
  }
}

void JoinPatches(const Adjacency& adjacency, const std::vector<bool>& is_patch,
                 std::vector<uint32_t>& labels) {
  if (is_patch.empty()) return;
  const uint32_t count = *std::ranges::max_element(labels) + 1;
  std::vector<bool> is_there(count, false);
  for (uint32_t f = 0; f < labels.size(); ++f)
    if (!is_patch[f]) is_there[labels[f]] = true;
  for (bool moved = true; std::exchange(moved, false);) {
    std::vector<uint32_t> target(count, kNoIndex);
    for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
      uint32_t least = kNoIndex;
      for (uint32_t f : adjacency.EdgeFaces(e))
        if (is_there[labels[f]]) least = std::min(least, labels[f]);
      for (uint32_t f : adjacency.EdgeFaces(e))
        if (!is_there[labels[f]])
          target[labels[f]] = std::min(target[labels[f]], least);
    }
    for (uint32_t& label : labels)
      if (target[label] != kNoIndex) {
        label = target[label];
        moved = true;
      }
  }
  const auto least = std::ranges::find(is_there, true);
  if (least == is_there.end()) return;
  for (uint32_t& label : labels)
    if (!is_there[label])
      label = static_cast<uint32_t>(least - is_there.begin());
}

}  // namespace marrow
