// A region -> its segments, by the bijection between medial structures and
// segments (sections 2.2 and 3 of the paper).
//
// What the paper leaves open is decided here:
//  - The region's boundary, onto which a seed is extended (section 3: "when
//    the vertex v lies in a boundary, we also extend it to a loop"), is made
//    of the edges between the region and the rest of the mesh. Holes of the
//    mesh are not boundaries of a segment. The loop is the connected set of
//    boundary edges that v lies on; loops that touch are one.
//  - A mean distance (Eq. 15) at or below zero means that there is nothing to
//    split.
//  - Faces of equal key leave the heap by face id, then front id.
//  - A front that is starved (it holds no face) is dropped, and so is its
//    medial structure.
//  - Fronts cross from shell to shell over face links, and a segment that
//    links hold together is in one piece.
//  - Faces that no front reaches (another connected piece of the region) go,
//    a piece as a whole, to the front that is nearest by Eq. 11.
//  - A segment in several pieces keeps the largest; the others go to the
//    segment with which they share the longest boundary, where there is one.
//  - The relaxation ends after kMaxIterations at the latest.
#ifndef MARROW_CORE_PIECES_SPLIT_REGION_H_
#define MARROW_CORE_PIECES_SPLIT_REGION_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pieces/face_links.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// The paper's parameters; ranges in core/pipeline/options.h.
struct SplitOptions {
  double kappa = 1.5;       // threshold of the initialisation, times Eq. 15
  double delta = 0.1;       // truncation of the diffusion map
  double epsilon = 0.01;    // tolerance around the least ADD, times Eq. 14
  double tolerance = 0.01;  // share of faces that may still move
};

// Why a region was not split.
enum class StopReason {
  kNone,              // it was split
  kOneSegment,        // no vertex is far enough from its medial structure
  kTooSmall,          // fewer than kMinRegionFaces faces, or no area
  kTooFewEigenPairs,  // its time scale wants pairs that are not there
  kDepth,             // not tried: the last level was reached
};

inline constexpr uint32_t kMinRegionFaces = 16;
inline constexpr uint32_t kMaxIterations = 50;
inline constexpr uint32_t kMaxMedialStructures = 40;

// The eigen-pairs of a mesh as far as they have been pulled.
struct PulledPairs {
  std::shared_ptr<const EigenPairs> pairs;  // not null
  // So many of them, the constant one not counted, are what anyone may use.
  // Those beyond are at hand only because others wanted them: where answers
  // depended on them, they would depend on the cache.
  uint32_t usable = 0;
  // What the time scale goes by (core/diffusion/slowest_mode.h); 0 where that is
  // the first eigenvalue.
  double slowest = 0;

  // REQUIRES: a pair besides the constant one.
  double Slowest() const {
    return slowest > 0 ? slowest : pairs->eigenvalues[1];
  }
};

// What all regions of one mesh share. The referents must outlive the use.
struct SplitContext {
  const TriangleMesh& mesh;
  const Adjacency& adjacency;
  const PulledPairs& pulled;
  const std::vector<double>& face_areas;  // in units of the mesh's whole area
  // Where the fronts step from shell to shell, as the operator does.
  FaceLinks links = {};
  double share = 1;  // Body::share by that of the largest body
  // By face, whether it fills a hole; empty where none does. A piece has
  // others.
  std::vector<bool> is_patch = {};
};

struct Piece {
  std::vector<uint32_t> faces;             // ascending, not empty
  std::vector<uint32_t> medial_structure;  // vertices, ascending
};

struct RegionSplit {
  // At least two, partitioning the region; empty where it was not split.
  std::vector<Piece> pieces;
  uint32_t iterations = 0;
  StopReason stop_reason = StopReason::kNone;
};

// Splits the region made of `faces` (ascending, not empty). Deterministic, the
// number of threads having no part in it. Errors: CANCELLED.
absl::StatusOr<RegionSplit> SplitRegion(const SplitContext& context,
                                        const std::vector<uint32_t>& faces,
                                        const SplitOptions& options,
                                        const CancelToken& cancel,
                                        int threads = 1);

// The medial structure of a region at its own time scale (Eq. 8 and 10), as far
// as the usable pairs go: a part of a region that was split has those that the
// region took.
std::vector<uint32_t> MedialStructureOf(const SplitContext& context,
                                        const std::vector<uint32_t>& faces,
                                        const SplitOptions& options);

}  // namespace marrow

#endif  // MARROW_CORE_PIECES_SPLIT_REGION_H_
