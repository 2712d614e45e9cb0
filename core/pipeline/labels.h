// Segments of the canonical mesh -> labels in the order of the payload.
#ifndef MARROW_CORE_PIPELINE_LABELS_H_
#define MARROW_CORE_PIPELINE_LABELS_H_

#include <cstdint>
#include <vector>

#include "core/mesh/adjacency.h"
#include "core/mesh/canonical_mesh.h"

namespace marrow {

// Decoded face -> the segment of its face. `face_segment` is the canonical
// faces' segment.
std::vector<uint32_t> LabelFaces(const CanonicalMesh& canonical,
                                 const std::vector<uint32_t>& face_segment);

// Decoded point -> the segment with most area around its vertex, the least of
// equals; kNoIndex for a point that no kept face has. `areas` are those of the
// canonical faces.
std::vector<uint32_t> LabelPoints(const CanonicalMesh& canonical,
                                  const Adjacency& adjacency,
                                  const std::vector<double>& areas,
                                  const std::vector<uint32_t>& face_segment);

}  // namespace marrow

#endif  // MARROW_CORE_PIPELINE_LABELS_H_
