// What segmenting a mesh will cost.
#ifndef MARROW_SERVER_PREDICTION_H_
#define MARROW_SERVER_PREDICTION_H_

#include <cstdint>

#include "core/mesh/mesh_report.h"

namespace marrow {

struct Prediction {
  double seconds = 0;
  uint64_t bytes = 0;  // at the peak
};

// For a mesh of which nothing is known yet; good to a factor of two. Attached
// components cost next to nothing.
Prediction PredictSegmentation(const MeshReport& report, uint32_t eigen_pairs);

}  // namespace marrow

#endif  // MARROW_SERVER_PREDICTION_H_
