#include "client/exporters/label_split.h"

#include <algorithm>
#include <cstddef>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace marrow {
namespace {

// Sorts as the pair (label, vertex) does.
uint64_t Key(uint32_t label, uint32_t vertex) {
  return (uint64_t{label} << 32) | vertex;
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
  std::vector<uint64_t> corner_keys;
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    if (mesh.Face(f).size() < 3) continue;
    split.faces.push_back(static_cast<uint32_t>(f));
    for (uint32_t v : mesh.Face(f)) {
      corner_keys.push_back(Key(face_labels[f], v));
    }
  }
  std::vector<uint64_t> keys = corner_keys;
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  for (uint64_t key : keys) {
    split.vertices.push_back(
        {static_cast<uint32_t>(key >> 32), static_cast<uint32_t>(key)});
  }
  for (uint64_t key : corner_keys) {
    split.corners.push_back(static_cast<uint32_t>(
        std::lower_bound(keys.begin(), keys.end(), key) - keys.begin()));
  }
  return split;
}

}  // namespace marrow
