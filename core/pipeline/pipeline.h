// The one entry point of core: Draco bytes in, levels out.
#ifndef MARROW_CORE_PIPELINE_PIPELINE_H_
#define MARROW_CORE_PIPELINE_PIPELINE_H_

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"
#include "core/hierarchy/segment_tree.h"
#include "core/mesh/canonical_mesh.h"
#include "core/mesh/decode.h"
#include "core/pipeline/options.h"
#include "core/pipeline/segmented_mesh.h"
#include "core/skeleton/skeleton.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

enum class Stage { kMesh, kSpectrum, kSegments };

// One level, in the order of the payload. References are valid during the call
// alone.
struct LevelResult {
  uint32_t level;           // 1 is the coarsest
  const SegmentTree& tree;  // so far; of the paper's method,
                            // splits of this level's segments are unknown
  // Decoded face -> node id.
  const std::vector<uint32_t>& face_labels;
  // Decoded point -> node id, that of the segment with most area around it
  // (ties: least id); kNoIndex for a point that no kept face has.
  const std::vector<uint32_t>& point_labels;
  const Skeleton& skeleton;
};

// Receives what Run() finds, on the thread that runs it. Every function answers
// whether to go on; after a false, Run() returns CANCELLED. None may block for
// long.
class Sink {
 public:
  virtual ~Sink() = default;
  // `fraction` of the whole run, 0 to 1, never falling.
  virtual bool OnProgress(Stage stage, double fraction) = 0;
  virtual bool OnMesh(const CanonicalMesh& mesh) = 0;
  // Before the next level is computed. Level 1 always comes.
  virtual bool OnLevel(const LevelResult& level) = 0;
  // The tree is whole: the splits (children, iterations, stop reason) of every
  // node are final.
  virtual bool OnTree(const SegmentTree& tree) = 0;
  // The last: what any cut of the tree is made from, for as long as it is held.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): others keep it.
  virtual bool OnSegmentedMesh(std::shared_ptr<const SegmentedMesh>) {
    return true;
  }
};

// DecodeDraco, then Canonicalize.
absl::StatusOr<CanonicalMesh> LoadMesh(
    std::string_view draco_bytes, const MeshLimits& limits,
    const CancelToken& cancel = CancelToken());

// For each canonical vertex, the least decoded point at it: how a vertex is
// named in results.
std::vector<uint32_t> PointOfVertex(const CanonicalMesh& mesh);

// Segments the mesh. Calls the sink in the order OnMesh, (OnLevel)+, OnTree,
// OnSegmentedMesh, with OnProgress between. Deterministic. Thread safe for
// different sinks. Errors: those of ValidateOptions, LoadMesh and
// EigenPairSource; CANCELLED.
absl::Status Run(std::string_view draco_bytes, const MeshLimits& limits,
                 const SegmentationOptions& options, EigenPairSource& pairs,
                 const CancelToken& cancel, Sink& sink);

// Tells the sink again what Run() told of the mesh, in the same order and to
// the last bit, progress aside. Errors: CANCELLED.
absl::Status Replay(const std::shared_ptr<const SegmentedMesh>& mesh,
                    const CancelToken& cancel, Sink& sink);

}  // namespace marrow

#endif  // MARROW_CORE_PIPELINE_PIPELINE_H_
