#include "server/prediction.h"

#include "core/spectrum/solver.h"

namespace marrow {

Prediction PredictSegmentation(const MeshReport& report, uint32_t eigen_pairs) {
  // Splitting takes its time for what is computed on, decoding, welding and
  // labelling for all faces, on a machine of today; measured like
  // PredictSolverSeconds().
  constexpr double kSecondsAVertex = 4e-5;
  constexpr double kSecondsAFace = 5e-6;
  constexpr uint64_t kBytesAFace = 600;
  return {PredictSolverSeconds(report.body_vertices, eigen_pairs) +
              kSecondsAVertex * static_cast<double>(report.body_vertices) +
              kSecondsAFace * static_cast<double>(report.faces),
          PredictSolverBytes(report.body_vertices, eigen_pairs) +
              kBytesAFace * report.faces};
}

}  // namespace marrow
