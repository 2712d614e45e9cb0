// Vertices split along the cuts: one copy a segment that uses the vertex.
#ifndef MARROW_CLIENT_EXPORTERS_LABEL_SPLIT_H_
#define MARROW_CLIENT_EXPORTERS_LABEL_SPLIT_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "client/polygon_mesh.h"

namespace marrow {

struct LabelSplit {
  struct Vertex {
    uint32_t label = 0;
    uint32_t vertex = 0;  // of the mesh
  };
  // Ascending by label, then by vertex. Only what an exported face uses.
  std::vector<Vertex> vertices;
  // Faces with three corners or more, in the mesh's order.
  std::vector<uint32_t> faces;
  // The corners of `faces`, one after the other, as indices into `vertices`.
  std::vector<uint32_t> corners;
};

// InvalidArgument unless there is one label a face.
absl::StatusOr<LabelSplit> SplitByLabel(const PolygonMesh& mesh,
                                        std::span<const uint32_t> face_labels);

}  // namespace marrow

#endif  // MARROW_CLIENT_EXPORTERS_LABEL_SPLIT_H_
