// A mesh that has been segmented, kept so that its tree can be cut again.
#ifndef MARROW_CORE_PIPELINE_SEGMENTED_MESH_H_
#define MARROW_CORE_PIPELINE_SEGMENTED_MESH_H_

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/hierarchy/cut.h"
#include "core/hierarchy/merged_pieces.h"
#include "core/hierarchy/segment_tree.h"
#include "core/mesh/canonical_mesh.h"
#include "core/operators/laplacian.h"
#include "core/pieces/split_region.h"
#include "core/skeleton/skeleton.h"

namespace marrow {

struct Prepared;
struct Workspace;

// A cut of the tree as it is told: labels in the order of the payload, the
// rest as in SegmentNode.
struct CutResult {
  struct Segment : TreeCut::Segment {
    double area = 0;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    std::vector<uint32_t> medial_structure;  // canonical vertices, ascending
    uint32_t decoded_faces = 0;              // how many have its label
  };
  std::vector<Segment> segments;  // ascending ids
  double salience = 0;            // TreeCut::salience
  std::vector<uint32_t> face_labels;
  std::vector<uint32_t> point_labels;  // kNoIndex as in LevelResult
  Skeleton skeleton;
};

// Holds the mesh, its eigen-pairs, its pieces and its tree. Immutable, hence
// thread safe.
class SegmentedMesh {
 public:
  // METHOD_MERGE; level k of the tree is the cut at thresholds[k - 1]. What is
  // moved in is not copied.
  SegmentedMesh(std::shared_ptr<const Workspace> workspace,
                const SplitOptions& options, SegmentTree tree,
                MergedPieces pieces, std::vector<double> thresholds);
  // METHOD_PAPER.
  SegmentedMesh(std::shared_ptr<const Workspace> workspace,
                const SplitOptions& options, SegmentTree tree);
  SegmentedMesh(const SegmentedMesh&) = delete;
  SegmentedMesh& operator=(const SegmentedMesh&) = delete;

  const CanonicalMesh& canonical() const;
  const Prepared& prepared() const;
  const SegmentTree& tree() const { return tree_; }

  // REQUIRES: ValidateCut() of the options it was segmented with (options.h).
  // Errors: those of TreeCutter::Apply(); CANCELLED. Time: linear in the mesh;
  // most of it goes to the medial structures of segments that are no nodes.
  absl::StatusOr<CutResult> Cut(const CutSpec& spec,
                                const CancelToken& cancel) const;

  // Those that could be used of its largest body, without the constant one:
  // what was asked for, or all that there are. Fewer were computed where fewer
  // were needed.
  uint32_t EigenPairCount() const;
  // What it took to make operators of its bodies' triangles.
  LaplacianReport OperatorReport() const;
  // Memory it holds, the eigen-pairs among it; good to a fifth.
  uint64_t Bytes() const;

 private:
  CutResult::Segment Measure(const TreeCut::Segment& segment,
                             const std::vector<uint32_t>& faces) const;
  std::vector<uint32_t> MedialStructure(
      const std::vector<uint32_t>& faces) const;

  const std::shared_ptr<const Workspace> workspace_;
  const SplitOptions options_;
  const SegmentTree tree_;
  const TreeCutter cutter_;
};

}  // namespace marrow

#endif  // MARROW_CORE_PIPELINE_SEGMENTED_MESH_H_
