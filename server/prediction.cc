#include "server/prediction.h"

#include "core/spectrum/solver.h"

namespace marrow {

Prediction PredictSegmentation(const MeshReport& report, uint32_t eigen_pairs) {
  // Decoding, welding and splitting, on a machine of today; measured like
  // PredictSolverSeconds().
  constexpr double kSecondsAFace = 2e-5;
  constexpr uint64_t kBytesAFace = 600;
  return {PredictSolverSeconds(report.body_vertices, eigen_pairs) +
              kSecondsAFace * static_cast<double>(report.faces),
          PredictSolverBytes(report.body_vertices, eigen_pairs) +
              kBytesAFace * report.faces};
}

}  // namespace marrow
