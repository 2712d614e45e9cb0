#include "core/hierarchy/merge_tree.h"

#include <algorithm>
#include <future>
#include <iterator>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/base/status_macros.h"
#include "core/boundaries/boundary_meter.h"
#include "core/boundaries/boundary_mover.h"
#include "core/boundaries/calibration.h"
#include "core/boundaries/curvature.h"
#include "core/boundaries/noise.h"
#include "core/boundaries/piece_graph.h"
#include "core/hierarchy/level_tree.h"
#include "core/hierarchy/tree_builder.h"
#include "core/operators/laplacian.h"
#include "core/pieces/region.h"
#include "core/pieces/stray_pieces.h"

namespace marrow {
namespace {

// The finding of the pieces takes about this share of the time.
constexpr double kPiecesDone = 0.7;
// Of the area of a piece: less than this on another shell is no piece there.
constexpr double kPassingShare = 0.1;
// And its eigen-pairs this share of a level.
constexpr double kPairsShare = 0.5;

// The leaves of the paper's tree.
struct Pieces {
  std::vector<uint32_t> of_face;      // numbered from 0
  std::vector<uint32_t> first_split;  // face -> segment of the first level
  SegmentTree tree;
};

absl::StatusOr<Pieces> FindPieces(const SplitContext& context,
                                  const SplitOptions& options, double mesh_area,
                                  const CancelToken& cancel,
                                  const PullCallback& pull,
                                  const std::function<void(double)>& progress) {
  TreeBuilder builder(context, options, mesh_area);
  for (uint32_t level = 0; level < kMostPieceLevels; ++level) {
    const double least = level < kPieceLevels ? 0 : kLargePiece;
    const auto report = [&](double share) {
      progress(kPiecesDone * std::min(1.0, (level + share) / kPieceLevels));
    };
    MARROW_RETURN_IF_ERROR(pull(builder.LeastShare(least), [&](double share) {
      report(kPairsShare * share);
    }));
    MARROW_ASSIGN_OR_RETURN(
        const bool deeper,
        builder.Deepen(
            cancel,
            [&](double share) {
              report(kPairsShare + (1 - kPairsShare) * share);
            },
            least, level < kPieceLevels ? 2 : kFewestOfLarge));
    if (!deeper) break;
  }
  const std::vector<uint32_t> leaves =
      builder.tree().SegmentsAtLevel(kMostPieceLevels);
  std::vector<uint32_t> piece = builder.tree().FaceSegments(kMostPieceLevels);
  for (uint32_t& p : piece)
    p = static_cast<uint32_t>(
        std::lower_bound(leaves.begin(), leaves.end(), p) - leaves.begin());
  std::vector<uint32_t> first_split = builder.tree().FaceSegments(1);
  return Pieces{std::move(piece), std::move(first_split), builder.TakeTree()};
}

// Fronts cross from shell to shell; where one ends there must be a boundary, or
// none could be kept. What a front took of the next shell in passing is no
// piece of that.
std::vector<uint32_t> OfOneShell(const SplitContext& context,
                                 std::vector<uint32_t> piece_of_face) {
  if (context.links.empty()) return piece_of_face;
  const size_t count =
      *std::max_element(piece_of_face.begin(), piece_of_face.end()) + 1;
  JoinStrayPieces(context.adjacency, context.face_areas, {}, count,
                  piece_of_face, kPassingShare);
  return ConnectedPieces(context.adjacency, piece_of_face);
}

// What boundaries are measured on.
struct Surface {
  TriangleMesh mesh;  // without noise
  std::vector<double> areas;
  Curvature curvature;
};

absl::StatusOr<Surface> MeasureSurface(const SplitContext& context,
                                       const CancelToken& cancel) {
  TriangleMesh mesh = WithoutNoise(context.mesh, context.adjacency);
  std::vector<double> areas = FaceAreaShares(mesh);
  MARROW_ASSIGN_OR_RETURN(Curvature curvature,
                          Curvature::Measure(mesh, context.adjacency, cancel));
  return Surface{std::move(mesh), std::move(areas), std::move(curvature)};
}

// Numbers the pieces anew from 0, the smallest first. Boundaries are moved in
// the order of the numbers, and where one ends up depends on those moved
// before: an order that goes by the surface alone lets noise change less.
void NumberByArea(const std::vector<double>& face_areas,
                  std::vector<uint32_t>& piece_of_face) {
  std::map<uint32_t, double> area;
  for (uint32_t f = 0; f < piece_of_face.size(); ++f)
    area[piece_of_face[f]] += face_areas[f];
  std::vector<std::pair<double, uint32_t>> order;
  order.reserve(area.size());
  for (const auto& [piece, share] : area) order.push_back({share, piece});
  std::sort(order.begin(), order.end());
  std::map<uint32_t, uint32_t> number;
  for (uint32_t i = 0; i < order.size(); ++i) number[order[i].second] = i;
  for (uint32_t& piece : piece_of_face) piece = number[piece];
}

// What the merging begins with: boundaries where they belong, without those
// that are a matter of chance.
absl::Status PlaceBoundaries(const SplitContext& context,
                             const Surface& surface, BoundaryMeter& meter,
                             const CancelToken& cancel,
                             std::vector<uint32_t>& piece_of_face) {
  const auto move = [&](double band_width) {
    NumberByArea(surface.areas, piece_of_face);
    return MoveBoundaries(surface.mesh, context.adjacency, surface.areas,
                          context.links, surface.curvature, band_width, cancel,
                          piece_of_face);
  };
  MARROW_RETURN_IF_ERROR(move(kBandWidth));
  MARROW_ASSIGN_OR_RETURN(
      const MergeOrder order,
      MergePieces(PieceGraph(context.adjacency, piece_of_face, surface.areas,
                             context.links),
                  meter, cancel, kChanceSalience));
  const std::vector<uint32_t> group = order.CutAt(kChanceSalience);
  for (uint32_t& piece : piece_of_face) piece = group[piece];
  return move(kMergedBandWidth);
}

}  // namespace

absl::StatusOr<MergeTree> BuildMergeTree(
    const SplitContext& context, const SplitOptions& options, double mesh_area,
    uint32_t levels, const CancelToken& cancel, const PullCallback& pull,
    const std::function<void(double)>& progress) {
  SplitOptions split = options;
  split.kappa = kPieceKappa;
  MergeTree result;
  // It takes nothing but the mesh, and one thread; so does the first split.
  std::future<absl::StatusOr<Surface>> measured = std::async(
      std::launch::async, [&] { return MeasureSurface(context, cancel); });
  MARROW_ASSIGN_OR_RETURN(Pieces pieces, FindPieces(context, split, mesh_area,
                                                    cancel, pull, progress));
  result.piece_of_face = OfOneShell(context, std::move(pieces.of_face));
  MARROW_ASSIGN_OR_RETURN(const Surface surface, measured.get());
  BoundaryMeter meter(surface.mesh, context.adjacency, surface.areas,
                      surface.curvature, context.share);
  MARROW_RETURN_IF_ERROR(
      PlaceBoundaries(context, surface, meter, cancel, result.piece_of_face));
  if (!context.is_patch.empty()) {
    JoinPatches(context.adjacency, context.is_patch, result.piece_of_face);
    NumberByArea(surface.areas, result.piece_of_face);
  }
  PieceGraph graph(context.adjacency, result.piece_of_face, surface.areas,
                   context.links);
  graph.SetFirstSplit(pieces.first_split, surface.areas);
  MARROW_ASSIGN_OR_RETURN(result.order,
                          MergePieces(std::move(graph), meter, cancel));
  const size_t count = std::min<size_t>(levels, std::size(kLevelSalience));
  MARROW_ASSIGN_OR_RETURN(
      result.tree,
      BuildLevelTree(context, split, mesh_area, result.piece_of_face,
                     result.order, std::span(kLevelSalience, count), cancel));
  NoteIterations(pieces.tree, context.face_areas, result.tree);
  const StopReason whole = pieces.tree.nodes[0].stop_reason;
  if (result.tree.nodes[0].children.empty() && whole != StopReason::kNone)
    result.tree.nodes[0].stop_reason = whole;
  progress(1);
  return result;
}

}  // namespace marrow
