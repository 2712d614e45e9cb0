#include "core/pieces/split_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/status_macros.h"
#include "core/diffusion/diffusion_map.h"
#include "core/pieces/fronts.h"
#include "core/pieces/medial_structure.h"
#include "core/pieces/region.h"
#include "core/pieces/stray_pieces.h"
#include "core/spectrum/team.h"

namespace marrow {
namespace {

struct Initialisation {
  std::vector<Structure> structures;
  std::vector<FrontDistance> nearest;  // of each vertex
};

// Initialisation of section 3: the region's own medial structure, then the
// farthest vertex from those there are, while it is far enough.
Initialisation InitialStructures(const Region& region, const MapSketch& sketch,
                                 const SplitOptions& options,
                                 const CancelToken& cancel, Team& team) {
  const DiffusionMap& Phi = sketch.Phi();
  const std::vector<uint32_t> all = region.AllFaces();
  Initialisation result;
  std::vector<Structure>& structures = result.structures;
  std::vector<FrontDistance>& nearest = result.nearest;
  structures = {ComputeMedialStructure(region, Phi, all, options.epsilon)};
  nearest.resize(region.NumVertices());
  std::vector<double> distance(region.NumVertices(),
                               std::numeric_limits<double>::infinity());
  double threshold = 0;
  while (!cancel.IsCancelled()) {
    const StructureDistance to_latest(sketch, structures.back());
    const auto front = static_cast<uint32_t>(structures.size() - 1);
    ForRanges(team, region.NumVertices(), cancel,
              [&](uint32_t first, uint32_t end) {
                uint32_t point = 0;
                for (uint32_t v = first; v < end; ++v) {
                  const double here = to_latest.From(point, v, distance[v]);
                  if (!(here < distance[v])) continue;
                  distance[v] = here;
                  nearest[v] = {front, point, here};
                }
              });
    if (structures.size() == 1) {
      threshold = options.kappa *
                  MeanDistance(Phi, {region.triangles(), region.areas(), all},
                               distance);
      if (threshold <= 0) break;
    }
    // The first of equal maxima: the least vertex.
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (!(*farthest > threshold) || structures.size() == kMaxMedialStructures)
      break;
    structures.push_back(region.BoundaryLoop(
        static_cast<uint32_t>(farthest - distance.begin())));
  }
  return result;
}

std::vector<std::vector<uint32_t>> FacesOfLabels(
    const std::vector<uint32_t>& labels, size_t count) {
  std::vector<std::vector<uint32_t>> faces(count);
  for (uint32_t f = 0; f < labels.size(); ++f) faces[labels[f]].push_back(f);
  return faces;
}

// Those of their first faces.
std::vector<uint32_t> VertexLabels(const Region& region,
                                   const std::vector<uint32_t>& labels) {
  std::vector<uint32_t> result(region.NumVertices());
  for (uint32_t v = 0; v < region.NumVertices(); ++v)
    result[v] = labels[region.adjacency().VertexFaces(v).front()];
  return result;
}

double ShareChanged(const std::vector<uint32_t>& a,
                    const std::vector<uint32_t>& b) {
  size_t changed = 0;
  for (size_t i = 0; i < a.size(); ++i) changed += a[i] != b[i];
  return static_cast<double>(changed) / a.size();
}

// Those of the segments that are not empty.
std::vector<Structure> StructuresOf(
    const Region& region, const DiffusionMap& Phi,
    const std::vector<std::vector<uint32_t>>& segments, double epsilon,
    Team& team) {
  std::vector<Structure> structures(segments.size());
  team.For(static_cast<int>(segments.size()), [&](int i) {
    if (!segments[i].empty())
      structures[i] = ComputeMedialStructure(region, Phi, segments[i], epsilon);
  });
  std::erase_if(structures, [](const Structure& s) { return s.empty(); });
  return structures;
}

struct Relaxation {
  std::vector<uint32_t> labels;  // local face -> segment
  uint32_t iterations = 0;
};

// The main loop of section 3, until the bijection.
Relaxation Relax(const Region& region, const MapSketch& sketch,
                 Initialisation&& initial, const SplitOptions& options,
                 const CancelToken& cancel, Team& team) {
  Relaxation result;
  std::vector<Structure>& structures = initial.structures;
  std::vector<FrontDistance>& known = initial.nearest;
  std::vector<uint32_t> before;
  while (result.iterations < kMaxIterations && !cancel.IsCancelled()) {
    result.labels = CompeteFronts(region, sketch, structures, cancel,
                                  std::exchange(known, {}));
    if (cancel.IsCancelled()) break;
    ++result.iterations;
    const auto segments = FacesOfLabels(result.labels, structures.size());
    const bool starved =
        std::any_of(segments.begin(), segments.end(),
                    [](const auto& faces) { return faces.empty(); });
    if (!starved && !before.empty() &&
        ShareChanged(before, result.labels) <= options.tolerance)
      break;
    structures =
        StructuresOf(region, sketch.Phi(), segments, options.epsilon, team);
    // Numbers shift when a front is dropped: nothing to compare with.
    before = starved ? std::vector<uint32_t>() : result.labels;
    // Most vertices meet the front again that they met before.
    if (!starved)
      known = DistancesTo(sketch, structures,
                          VertexLabels(region, result.labels), cancel, team);
  }
  return result;
}

// In mesh faces and vertices, without the empty ones.
std::vector<Piece> MakePieces(const Region& region, const DiffusionMap& Phi,
                              const std::vector<uint32_t>& labels,
                              size_t num_labels, double epsilon) {
  std::vector<Piece> pieces;
  for (const auto& faces : FacesOfLabels(labels, num_labels)) {
    if (faces.empty()) continue;
    Piece& piece = pieces.emplace_back();
    for (uint32_t f : faces) piece.faces.push_back(region.MeshFace(f));
    for (uint32_t v : ComputeMedialStructure(region, Phi, faces, epsilon))
      piece.medial_structure.push_back(region.mesh_vertices()[v]);
  }
  return pieces;
}

// By local face; empty where the mesh has none.
std::vector<bool> PatchesOf(const SplitContext& context, const Region& region) {
  std::vector<bool> is_patch;
  if (context.is_patch.empty()) return is_patch;
  for (uint32_t f = 0; f < region.NumFaces(); ++f)
    is_patch.push_back(context.is_patch[region.MeshFace(f)]);
  return is_patch;
}

RegionSplit Unsplit(StopReason reason) {
  RegionSplit split;
  split.stop_reason = reason;
  return split;
}

}  // namespace

absl::StatusOr<RegionSplit> SplitRegion(const SplitContext& context,
                                        const std::vector<uint32_t>& faces,
                                        const SplitOptions& options,
                                        const CancelToken& cancel,
                                        int threads) {
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const Region region(context.mesh, context.adjacency, context.face_areas,
                      faces, context.links);
  const EigenPairs& pairs = *context.pulled.pairs;
  if (faces.size() < kMinRegionFaces || region.area() <= 0)
    return Unsplit(StopReason::kTooSmall);
  if (pairs.NumPairs() < 2) return Unsplit(StopReason::kTooFewEigenPairs);
  const double t = TimeScale(context.pulled.Slowest(), region.area());
  const std::optional<uint32_t> dimension =
      MapDimension(pairs, t, options.delta);
  if (!dimension) return Unsplit(StopReason::kTooFewEigenPairs);
  const DiffusionMap Phi =
      BuildDiffusionMap(pairs, region.mesh_vertices(), t, *dimension);
  const MapSketch sketch(Phi);

  Team team(threads);
  Initialisation initial =
      InitialStructures(region, sketch, options, cancel, team);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const size_t num_labels = initial.structures.size();
  if (num_labels < 2) return Unsplit(StopReason::kOneSegment);
  Relaxation relaxed =
      Relax(region, sketch, std::move(initial), options, cancel, team);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  JoinStrayPieces(region.adjacency(), region.areas(), region.links(),
                  num_labels, relaxed.labels);
  JoinPatches(region.adjacency(), PatchesOf(context, region), relaxed.labels);

  RegionSplit split;
  split.iterations = relaxed.iterations;
  split.pieces =
      MakePieces(region, Phi, relaxed.labels, num_labels, options.epsilon);
  if (split.pieces.size() < 2) {
    split.pieces.clear();
    split.stop_reason = StopReason::kOneSegment;
  }
  return split;
}

std::vector<uint32_t> MedialStructureOf(const SplitContext& context,
                                        const std::vector<uint32_t>& faces,
                                        const SplitOptions& options) {
  const Region region(context.mesh, context.adjacency, context.face_areas,
                      faces, context.links);
  const auto& pairs = context.pulled.pairs;
  const uint32_t usable = context.pulled.usable;
  if (usable == 0 || region.area() <= 0) return region.mesh_vertices();
  const double t = TimeScale(context.pulled.Slowest(), region.area());
  const uint32_t wanted =
      MapDimension(*pairs, t, options.delta).value_or(usable);
  const DiffusionMap Phi = BuildDiffusionMap(*pairs, region.mesh_vertices(), t,
                                             std::min(wanted, usable));
  std::vector<uint32_t> result;
  for (uint32_t v :
       ComputeMedialStructure(region, Phi, region.AllFaces(), options.epsilon))
    result.push_back(region.mesh_vertices()[v]);
  return result;
}

}  // namespace marrow
