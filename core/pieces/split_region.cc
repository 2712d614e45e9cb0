#include "core/pieces/split_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/base/status_macros.h"
#include "core/diffusion/diffusion_map.h"
#include "core/pieces/fronts.h"
#include "core/pieces/medial_structure.h"
#include "core/pieces/region.h"

namespace marrow {
namespace {

struct Initialisation {
  std::vector<Structure> structures;
  std::vector<FrontDistance> nearest;  // of each vertex
};

// Initialisation of section 3: the region's own medial structure, then the
// farthest vertex from those there are, while it is far enough.
Initialisation InitialStructures(const Region& region, const DiffusionMap& Phi,
                                 const SplitOptions& options,
                                 const CancelToken& cancel) {
  const std::vector<uint32_t> all = region.AllFaces();
  Initialisation result;
  auto& [structures, nearest] = result;
  structures = {ComputeMedialStructure(region, Phi, all, options.epsilon)};
  nearest.resize(region.NumVertices());
  std::vector<double> distance(region.NumVertices(),
                               std::numeric_limits<double>::infinity());
  double threshold = 0;
  while (!cancel.IsCancelled()) {
    const StructureDistance to_latest(Phi, structures.back());
    const auto front = static_cast<uint32_t>(structures.size() - 1);
    uint32_t point = 0;
    for (uint32_t v = 0; v < region.NumVertices(); ++v) {
      const double here = to_latest.From(point, v);
      if (!(here < distance[v])) continue;
      distance[v] = here;
      nearest[v] = {front, point, here};
    }
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

// The vertices' labels, those of their first faces, decide the convergence.
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

struct Relaxation {
  std::vector<uint32_t> labels;  // local face -> segment
  uint32_t iterations = 0;
};

// The main loop of section 3, until the bijection.
Relaxation Relax(const Region& region, const DiffusionMap& Phi,
                 Initialisation initial, const SplitOptions& options,
                 const CancelToken& cancel) {
  Relaxation result;
  std::vector<Structure> structures = std::move(initial.structures);
  std::vector<uint32_t> before;
  while (result.iterations < kMaxIterations && !cancel.IsCancelled()) {
    result.labels = CompeteFronts(region, Phi, structures, cancel,
                                  std::exchange(initial.nearest, {}));
    if (cancel.IsCancelled()) break;
    ++result.iterations;
    const auto segments = FacesOfLabels(result.labels, structures.size());
    std::vector<uint32_t> now = VertexLabels(region, result.labels);
    const bool starved =
        std::any_of(segments.begin(), segments.end(),
                    [](const auto& faces) { return faces.empty(); });
    if (!starved && !before.empty() &&
        ShareChanged(before, now) <= options.tolerance)
      break;
    structures.clear();
    for (const auto& faces : segments)
      if (!faces.empty())
        structures.push_back(
            ComputeMedialStructure(region, Phi, faces, options.epsilon));
    // Numbers shift when a front is dropped: nothing to compare with.
    before = starved ? std::vector<uint32_t>() : std::move(now);
  }
  return result;
}

// Connected pieces of faces with one label: piece of each face, and its label.
struct LabelPieces {
  std::vector<uint32_t> piece;
  std::vector<uint32_t> label;
  std::vector<double> area;
};

LabelPieces FindLabelPieces(const Region& region,
                            const std::vector<uint32_t>& labels) {
  LabelPieces result;
  result.piece = ConnectedPieces(region.adjacency(), labels, region.links());
  for (uint32_t f = 0; f < labels.size(); ++f) {
    if (result.piece[f] == result.label.size()) {
      result.label.push_back(labels[f]);
      result.area.push_back(0);
    }
    result.area[result.piece[f]] += region.areas()[f];
  }
  return result;
}

// For each piece, the label with which it shares the longest boundary, counted
// in edges and links; its own where it touches no other. Only pieces that are
// the largest of their label count as neighbours, so that every move ends in
// one.
class LongestNeighbour {
 public:
  LongestNeighbour(const LabelPieces& pieces, const std::vector<bool>& is_main)
      : pieces_(pieces), is_main_(is_main) {}

  // The faces of one edge or link. Strays and main pieces are told apart
  // first: where a thousand pages meet, there are few main pieces.
  void Meet(std::span<const uint32_t> faces) {
    strays_.clear();
    mains_.clear();
    for (uint32_t f : faces) {
      const uint32_t piece = pieces_.piece[f];
      (is_main_[piece] ? mains_ : strays_).push_back(piece);
    }
    if (strays_.empty() || mains_.empty()) return;
    for (std::vector<uint32_t>* list : {&strays_, &mains_}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    for (uint32_t stray : strays_)
      for (uint32_t main : mains_) ++shared_[{stray, pieces_.label[main]}];
  }

  std::vector<uint32_t> Labels() const {
    std::vector<uint32_t> result = pieces_.label, longest(result.size(), 0);
    for (const auto& [key, count] : shared_)
      if (count > longest[key.first]) {
        longest[key.first] = count;
        result[key.first] = key.second;
      }
    return result;
  }

 private:
  const LabelPieces& pieces_;
  const std::vector<bool>& is_main_;
  std::vector<uint32_t> strays_, mains_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> shared_;
};

// Leaves every segment in one piece where the region is in one.
void JoinStrayPieces(const Region& region, size_t num_labels,
                     std::vector<uint32_t>& labels) {
  // A stray that touches only strays is reached once they have moved.
  for (int round = 0; round < 8; ++round) {
    const LabelPieces pieces = FindLabelPieces(region, labels);
    std::vector<uint32_t> main(num_labels, kNoIndex);
    for (uint32_t p = 0; p < pieces.label.size(); ++p) {
      uint32_t& best = main[pieces.label[p]];
      if (best == kNoIndex || pieces.area[p] > pieces.area[best]) best = p;
    }
    std::vector<bool> is_main(pieces.label.size(), false);
    for (uint32_t p : main)
      if (p != kNoIndex) is_main[p] = true;
    if (std::ranges::find(is_main, false) == is_main.end()) return;
    LongestNeighbour neighbours(pieces, is_main);
    for (uint32_t e = 0; e < region.adjacency().NumEdges(); ++e)
      neighbours.Meet(region.adjacency().EdgeFaces(e));
    for (const auto& link : region.links()) neighbours.Meet(link);
    const std::vector<uint32_t> target = neighbours.Labels();
    bool moved = false;
    for (uint32_t f = 0; f < labels.size(); ++f) {
      moved |= labels[f] != target[pieces.piece[f]];
      labels[f] = target[pieces.piece[f]];
    }
    if (!moved) return;
  }
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

RegionSplit Unsplit(StopReason reason) {
  RegionSplit split;
  split.stop_reason = reason;
  return split;
}

}  // namespace

absl::StatusOr<RegionSplit> SplitRegion(const SplitContext& context,
                                        const std::vector<uint32_t>& faces,
                                        const SplitOptions& options,
                                        const CancelToken& cancel) {
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const Region region(context.mesh, context.adjacency, context.face_areas,
                      faces, context.links);
  if (faces.size() < kMinRegionFaces || region.area() <= 0 ||
      context.pairs.NumPairs() < 2)
    return Unsplit(StopReason::kTooSmall);
  const double t = TimeScale(context.pairs, region.area());
  const std::optional<uint32_t> dimension =
      MapDimension(context.pairs, t, options.delta);
  if (!dimension) return Unsplit(StopReason::kTooFewEigenPairs);
  const DiffusionMap Phi =
      BuildDiffusionMap(context.pairs, region.mesh_vertices(), t, *dimension);

  Initialisation initial = InitialStructures(region, Phi, options, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const size_t num_labels = initial.structures.size();
  if (num_labels < 2) return Unsplit(StopReason::kOneSegment);
  Relaxation relaxed = Relax(region, Phi, std::move(initial), options, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  JoinStrayPieces(region, num_labels, relaxed.labels);

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
  if (context.pairs.NumPairs() < 2 || region.area() <= 0)
    return region.mesh_vertices();
  const double t = TimeScale(context.pairs, region.area());
  const DiffusionMap Phi =
      BuildDiffusionMap(context.pairs, region.mesh_vertices(), t,
                        MapDimension(context.pairs, t, options.delta)
                            .value_or(context.pairs.NumPairs() - 1));
  std::vector<uint32_t> result;
  for (uint32_t v :
       ComputeMedialStructure(region, Phi, region.AllFaces(), options.epsilon))
    result.push_back(region.mesh_vertices()[v]);
  return result;
}

}  // namespace marrow
