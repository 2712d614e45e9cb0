#include "core/operators/body.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace marrow {

std::vector<bool> PatchesOf(const Body& body) {
  if (body.patched == nullptr) return {};
  std::vector<bool> is_patch(body.Computed().mesh.NumFaces(), true);
  for (uint32_t f = 0; f < body.faces.size(); ++f)
    is_patch[body.coarse == nullptr ? f : body.coarse->coarse_face[f]] = false;
  return is_patch;
}

std::vector<uint32_t> ToWholeVertices(const Body& body,
                                      const TriangleMesh& whole,
                                      std::vector<uint32_t> own,
                                      const std::vector<uint32_t>& faces) {
  for (uint32_t& v : own) v = body.vertices[v];
  own.erase(std::unique(own.begin(), own.end()), own.end());
  if (body.seams.empty()) return own;
  std::vector<uint32_t> corners;
  for (uint32_t f : faces)
    corners.insert(corners.end(), whole.faces[f].begin(), whole.faces[f].end());
  std::sort(corners.begin(), corners.end());
  const auto has = [&](uint32_t v) {
    return std::binary_search(corners.begin(), corners.end(), v);
  };
  for (uint32_t& v : own) {
    if (has(v)) continue;
    auto seam =
        std::lower_bound(body.seams.begin(), body.seams.end(), Bridge{v, 0});
    for (; seam != body.seams.end() && (*seam)[0] == v; ++seam)
      if (has((*seam)[1])) break;
    if (seam != body.seams.end() && (*seam)[0] == v) v = (*seam)[1];
  }
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  return own;
}

uint32_t PairsOfBody(const Body& body, uint32_t count) {
  constexpr uint32_t kLeast = 60;
  // Not one more for what rounding adds to the share.
  const double share = std::ceil(body.share * count - 1e-6);
  return std::min(count, std::max(kLeast, static_cast<uint32_t>(share)));
}

}  // namespace marrow
