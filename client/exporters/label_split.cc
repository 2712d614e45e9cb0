#include "client/exporters/label_split.h"

#include <algorithm>
#include <cstddef>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace marrow {
namespace {

// Of a vertex that no mesh has room for.
constexpr uint64_t kNoKey = ~uint64_t{0};

// Sorts as the pair (label, vertex) does.
uint64_t Key(uint32_t label, uint32_t vertex) {
  return (uint64_t{label} << 32) | vertex;
}

struct Keys {
  std::vector<uint64_t> of_corners;
  std::vector<uint64_t> distinct;  // ascending
};

// Most vertices have one label: what was the latest key of its vertex needs no
// sorting out.
Keys KeysOf(const PolygonMesh& mesh, std::span<const uint32_t> faces,
            std::span<const uint32_t> face_labels) {
  Keys keys;
  std::vector<uint64_t> latest(mesh.NumVertices(), kNoKey);
  for (uint32_t f : faces) {
    for (uint32_t v : mesh.Face(f)) {
      const uint64_t key = Key(face_labels[f], v);
      keys.of_corners.push_back(key);
      if (latest[v] != key) keys.distinct.push_back(key);
      latest[v] = key;
    }
  }
  std::sort(keys.distinct.begin(), keys.distinct.end());
  keys.distinct.erase(std::unique(keys.distinct.begin(), keys.distinct.end()),
                      keys.distinct.end());
  return keys;
}

// Corner -> the place of its key. The latest of a vertex needs no searching.
std::vector<uint32_t> PlacesOf(const Keys& keys, size_t num_vertices) {
  const std::vector<uint64_t>& distinct = keys.distinct;
  std::vector<uint32_t> places, latest(num_vertices, 0);
  places.reserve(keys.of_corners.size());
  for (uint64_t key : keys.of_corners) {
    uint32_t& place = latest[static_cast<uint32_t>(key)];
    if (distinct[place] != key) {
      place = static_cast<uint32_t>(
          std::lower_bound(distinct.begin(), distinct.end(), key) -
          distinct.begin());
    }
    places.push_back(place);
  }
  return places;
}

}  // namespace

absl::StatusOr<LabelSplit> SplitByLabel(const PolygonMesh& mesh,
                                        std::span<const uint32_t> face_labels) {
  if (face_labels.size() != mesh.NumFaces()) {
    return absl::InvalidArgumentError(
        absl::StrCat("got ", face_labels.size(), " face labels for a mesh of ",
                     mesh.NumFaces(), " faces; pass one label a face"));
  }
  LabelSplit split;
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    if (mesh.Face(f).size() >= 3) {
      split.faces.push_back(static_cast<uint32_t>(f));
    }
  }
  const Keys keys = KeysOf(mesh, split.faces, face_labels);
  for (uint64_t key : keys.distinct) {
    split.vertices.push_back(
        {static_cast<uint32_t>(key >> 32), static_cast<uint32_t>(key)});
  }
  split.corners = PlacesOf(keys, mesh.NumVertices());
  return split;
}

}  // namespace marrow
