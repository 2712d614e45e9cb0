// What the methods share: a prepared mesh, its bodies, and the way to the sink.
#ifndef MARROW_CORE_PIPELINE_JOB_H_
#define MARROW_CORE_PIPELINE_JOB_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/diffusion/slowest_mode.h"
#include "core/hierarchy/segment_tree.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/canonical_mesh.h"
#include "core/operators/bodies.h"
#include "core/operators/bridges.h"
#include "core/pieces/split_region.h"
#include "core/pipeline/options.h"
#include "core/pipeline/pipeline.h"
#include "core/pipeline/segmented_mesh.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// Shares of the whole run, by what meshes of 5k to 50k faces take.
inline constexpr double kMeshDone = 0.05;
inline constexpr double kSpectrumDone = 0.75;

// Reports to the sink and cancels the run once the sink has had enough. The
// referents must outlive it.
class Reporter {
 public:
  Reporter(Sink& sink, const CancelToken& cancel)
      : sink_(sink), cancel_(cancel) {}

  absl::Status Took(bool go_on);
  // Never falls: a lesser fraction is taken for the greatest so far.
  absl::Status Progress(Stage stage, double fraction);

 private:
  Sink& sink_;
  const CancelToken& cancel_;
  double fraction_ = 0;
};

// The whole mesh with what every level needs beside it.
struct Prepared {
  const CanonicalMesh& canonical;
  const Bodies& bodies;
  Adjacency adjacency;
  std::vector<double> areas;  // shares of the mesh's
  std::vector<Bridge> bridges;
};
// Of no use once cancelled.
Prepared Prepare(const CanonicalMesh& canonical, const Bodies& bodies,
                 const CancelToken& cancel);

// What is computed on of a body, ready to be split. Where that is the whole
// mesh, what is prepared is used again, so `prepared` and the body must outlive
// it.
class PreparedBody {
 public:
  // Of a stream of `most_pairs`. There are no pairs before the first Pull().
  // Errors: CANCELLED.
  static absl::StatusOr<std::unique_ptr<PreparedBody>> Make(
      const Prepared& prepared, const Body& body, uint32_t most_pairs,
      std::unique_ptr<EigenPairStream> stream, const CancelToken& cancel);
  PreparedBody(const PreparedBody&) = delete;
  PreparedBody& operator=(const PreparedBody&) = delete;

  // Sees to it that the usable pairs suffice for regions of at least
  // `area_share` of the body, unless the stream ends before. Errors: those of
  // EigenPairStream. REQUIRES: area_share > 0.
  absl::Status Pull(double area_share, double delta, const CancelToken& cancel,
                    const ProgressCallback& progress);

  const SplitContext& context() const { return context_; }
  double area() const { return area_; }    // in units of the positions
  double share() const { return share_; }  // of the area of all bodies
  // What may be pulled in all, the constant pair not counted.
  uint32_t most_pairs() const { return most_pairs_; }

 private:
  struct Own;

  PreparedBody(const Prepared& prepared, const Body& body,
               std::shared_ptr<const Own> own,
               const std::vector<Bridge>& bridges, uint32_t most_pairs,
               std::unique_ptr<EigenPairStream> stream);
  // Pulls what the time scale goes by, the first time.
  absl::Status FindSlowest(const CancelToken& cancel,
                           const ProgressCallback& progress);
  absl::Status PullUpTo(double bound, const CancelToken& cancel,
                        const ProgressCallback& progress);

  const double area_;
  const double share_;
  const uint32_t most_pairs_;
  const std::shared_ptr<const Own> own_;
  const SlowestMode slowest_;
  std::unique_ptr<EigenPairStream> stream_;  // null once it has ended
  PulledPairs pulled_;
  const SplitContext context_;
};

// A mesh and all that segmenting it takes. Its parts refer to each other, so it
// stays where it is made; immutable once all of them are there.
struct Workspace {
  Workspace() = default;
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  CanonicalMesh canonical;
  Bodies bodies;
  std::optional<Prepared> prepared;
  std::vector<std::unique_ptr<PreparedBody>> prepared_bodies;
};

// What is told, and whom.
struct Telling {
  const Prepared& prepared;
  Reporter& reporter;
  Sink& sink;
};

// What a method reads and whom it tells.
struct Job {
  std::shared_ptr<const Workspace> workspace;
  const Prepared& prepared;
  const std::vector<std::unique_ptr<PreparedBody>>& bodies;  // not pulled yet
  const SegmentationOptions& options;
  const CancelToken& cancel;
  Reporter& reporter;
  Sink& sink;

  Telling telling() const { return {prepared, reporter, sink}; }
};

// Pulls what the bodies take as a whole, reported as Stage::kSpectrum; regions
// of them take more.
absl::Status PullPairs(const Job& job);

// Labels and skeleton of a level, to the sink.
absl::Status EmitLevel(const Telling& to, const SegmentTree& tree,
                       uint32_t level);
// The whole tree, and the mesh to cut it again, to the sink.
absl::Status EmitTree(const Telling& to,
                      std::shared_ptr<const SegmentedMesh> whole);

}  // namespace marrow

#endif  // MARROW_CORE_PIPELINE_JOB_H_
