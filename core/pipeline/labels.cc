#include "core/pipeline/labels.h"

#include <algorithm>
#include <utility>

namespace marrow {

std::vector<uint32_t> LabelFaces(const CanonicalMesh& canonical,
                                 const std::vector<uint32_t>& face_segment) {
  std::vector<uint32_t> labels;
  labels.reserve(canonical.face_map.size());
  for (uint32_t f : canonical.face_map) labels.push_back(face_segment[f]);
  return labels;
}

std::vector<uint32_t> LabelPoints(const CanonicalMesh& canonical,
                                  const Adjacency& adjacency,
                                  const std::vector<double>& areas,
                                  const std::vector<uint32_t>& face_segment) {
  const uint32_t n = canonical.mesh.NumVertices();
  std::vector<uint32_t> of_vertex(n);
  std::vector<std::pair<uint32_t, double>> around;
  for (uint32_t v = 0; v < n; ++v) {
    around.clear();
    for (uint32_t f : adjacency.VertexFaces(v))
      around.push_back({face_segment[f], areas[f]});
    std::sort(around.begin(), around.end());
    double most = -1;
    for (size_t i = 0; i < around.size();) {
      double sum = 0;
      const uint32_t segment = around[i].first;
      for (; i < around.size() && around[i].first == segment; ++i)
        sum += around[i].second;
      if (sum > most) {
        most = sum;
        of_vertex[v] = segment;
      }
    }
  }
  std::vector<uint32_t> labels(canonical.point_map.size(), kNoIndex);
  for (size_t p = 0; p < labels.size(); ++p)
    if (canonical.point_map[p] != kNoIndex)
      labels[p] = of_vertex[canonical.point_map[p]];
  return labels;
}

}  // namespace marrow
