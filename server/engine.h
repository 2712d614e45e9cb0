// What the service calls to compute: core, unless a test puts something else
// in its place.
#ifndef MARROW_SERVER_ENGINE_H_
#define MARROW_SERVER_ENGINE_H_

#include <functional>
#include <memory>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/pipeline/pipeline.h"
#include "core/spectrum/solver.h"
#include "core/spectrum/strict_solver.h"

namespace marrow {

// The functions are called on many threads at a time.
struct Engine {
  std::function<absl::StatusOr<CanonicalMesh>(
      std::string_view, const MeshLimits&, const CancelToken&)>
      load_mesh = LoadMesh;
  std::function<absl::Status(std::string_view, const MeshLimits&,
                             const SegmentationOptions&, EigenPairSource&,
                             const CancelToken&, Sink&)>
      run = Run;
  // The cache of eigen-pairs stands before it.
  std::shared_ptr<EigenPairSource> solver =
      std::make_shared<SolverEigenPairSource>();
  // For strict spectra.
  std::function<absl::StatusOr<CertifiedSpectrum>(
      const CanonicalMesh&, uint32_t count, const CancelToken&,
      const ProgressCallback&)>
      solve_strictly = SolveStrictly;
};

}  // namespace marrow

#endif  // MARROW_SERVER_ENGINE_H_
