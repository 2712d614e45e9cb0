#include "core/pipeline/segmented_mesh.h"

#include <algorithm>
#include <utility>

#include "core/base/status_macros.h"
#include "core/hierarchy/fine_tree.h"
#include "core/hierarchy/segment_node.h"
#include "core/pipeline/job.h"
#include "core/pipeline/labels.h"

namespace marrow {
namespace {

// The coarse faces whose own fine one is among `faces`, ascending; that of the
// first where there are none.
std::vector<uint32_t> ComputedFaces(const CoarseMesh& coarse,
                                    const std::vector<uint32_t>& faces) {
  std::vector<uint32_t> computed;
  for (uint32_t f : faces)
    if (coarse.faces[coarse.coarse_face[f]] == f)
      computed.push_back(coarse.coarse_face[f]);
  if (computed.empty()) computed.push_back(coarse.coarse_face[faces.front()]);
  std::sort(computed.begin(), computed.end());
  return computed;
}

}  // namespace

SegmentedMesh::SegmentedMesh(std::shared_ptr<const Workspace> workspace,
                             const SplitOptions& options, SegmentTree tree,
                             MergedPieces pieces,
                             std::vector<double> thresholds)
    : workspace_(std::move(workspace)),
      options_(options),
      tree_(std::move(tree)),
      cutter_(tree_, std::move(pieces.piece_of_face), std::move(pieces.order),
              std::move(thresholds)) {}

SegmentedMesh::SegmentedMesh(std::shared_ptr<const Workspace> workspace,
                             const SplitOptions& options, SegmentTree tree)
    : workspace_(std::move(workspace)),
      options_(options),
      tree_(std::move(tree)),
      cutter_(tree_, workspace_->bodies.bodies.size() > 1) {}

const CanonicalMesh& SegmentedMesh::canonical() const {
  return workspace_->canonical;
}

const Prepared& SegmentedMesh::prepared() const {
  return *workspace_->prepared;
}

absl::StatusOr<CutResult> SegmentedMesh::Cut(const CutSpec& spec,
                                             const CancelToken& cancel) const {
  MARROW_ASSIGN_OR_RETURN(const TreeCut cut, cutter_.Apply(spec));
  const uint32_t num_faces = canonical().mesh.NumFaces();
  SegmentCover cover;
  cover.place_of_face.reserve(num_faces);
  std::vector<uint32_t> face_segment;
  face_segment.reserve(num_faces);
  // Of segments that are nodes the tree knows all that has to be measured.
  std::vector<std::vector<uint32_t>> faces(cut.segments.size());
  for (uint32_t f = 0; f < num_faces; ++f) {
    const uint32_t place = cut.segment_of_piece[cutter_.piece_of_face()[f]];
    cover.place_of_face.push_back(place);
    face_segment.push_back(cut.segments[place].id);
    if (face_segment[f] >= tree_.nodes.size()) faces[place].push_back(f);
  }

  CutResult result;
  result.salience = cut.salience;
  for (size_t s = 0; s < cut.segments.size(); ++s) {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    result.segments.push_back(Measure(cut.segments[s], faces[s]));
    cover.ids.push_back(cut.segments[s].id);
    cover.centres.push_back(result.segments[s].centroid);
  }
  for (uint32_t f : canonical().face_map)
    ++result.segments[cover.place_of_face[f]].decoded_faces;
  result.face_labels = LabelFaces(canonical(), face_segment);
  result.point_labels = LabelPoints(canonical(), prepared().adjacency,
                                    prepared().areas, face_segment);
  result.skeleton =
      BuildSkeleton(canonical().mesh, prepared().adjacency, cover,
                    tree_.nodes[0].medial_structure, prepared().bridges);
  return result;
}

CutResult::Segment SegmentedMesh::Measure(
    const TreeCut::Segment& segment, const std::vector<uint32_t>& faces) const {
  CutResult::Segment measured;
  static_cast<TreeCut::Segment&>(measured) = segment;
  if (segment.id < tree_.nodes.size()) {
    const SegmentNode& node = tree_.nodes[segment.id];
    measured.area = node.area;
    measured.centroid = node.centroid;
    measured.medial_structure = node.medial_structure;
    return measured;
  }
  SegmentNode node;
  node.faces = faces;
  MeasureNode(canonical().mesh, prepared().areas, canonical().report.area, node,
              workspace_->bodies.anchors);
  measured.area = node.area;
  measured.centroid = node.centroid;
  measured.medial_structure = MedialStructure(faces);
  return measured;
}

// Attached faces are left out, as in the tree. What is no node is of one body.
std::vector<uint32_t> SegmentedMesh::MedialStructure(
    const std::vector<uint32_t>& faces) const {
  const Bodies& bodies = workspace_->bodies;
  const uint32_t anchor = bodies.anchors[faces.front()];
  size_t b = 0;
  while (!std::binary_search(bodies.bodies[b].faces.begin(),
                             bodies.bodies[b].faces.end(), anchor))
    ++b;
  const Body& body = bodies.bodies[b];
  std::vector<uint32_t> own;
  for (uint32_t f : faces)
    if (bodies.anchors[f] == f)
      own.push_back(static_cast<uint32_t>(
          std::lower_bound(body.faces.begin(), body.faces.end(), f) -
          body.faces.begin()));
  const SplitContext& context = workspace_->prepared_bodies[b]->context();
  std::vector<uint32_t> vertices;
  if (body.coarse == nullptr) {
    vertices = MedialStructureOf(context, own, options_);
  } else {
    vertices =
        MedialStructureOf(context, ComputedFaces(*body.coarse, own), options_);
    vertices = ToFine(vertices, *body.coarse, body.Patched().mesh, own);
  }
  return ToWholeVertices(body, prepared().canonical.mesh, std::move(vertices),
                         faces);
}

uint32_t SegmentedMesh::EigenPairCount() const {
  uint32_t most = 0;
  for (const auto& body : workspace_->prepared_bodies)
    most = std::max(most, body->most_pairs());
  return most;
}

LaplacianReport SegmentedMesh::OperatorReport() const {
  LaplacianReport sum;
  for (const auto& body : workspace_->prepared_bodies)
    sum.Add(body->context().pulled.pairs->laplacian);
  return sum;
}

uint64_t SegmentedMesh::Bytes() const {
  // The canonical mesh, its maps, its adjacency; the bodies have them again
  // where they are not the mesh itself.
  constexpr uint64_t kBytesAFace = 120;
  const bool is_patched = std::ranges::any_of(
      workspace_->bodies.bodies,
      [](const Body& body) { return body.patched != nullptr; });
  const uint64_t copies = (workspace_->bodies.IsWhole() ? 1 : 2) + is_patched;
  uint64_t bytes = copies * kBytesAFace * canonical().mesh.NumFaces() +
                   sizeof(uint32_t) * (canonical().face_map.size() +
                                       canonical().point_map.size());
  for (const auto& body : workspace_->prepared_bodies)
    bytes += body->context().pulled.pairs->Bytes();
  for (const SegmentNode& node : tree_.nodes)
    bytes +=
        sizeof(SegmentNode) +
        sizeof(uint32_t) * (node.faces.size() + node.medial_structure.size());
  return bytes;
}

}  // namespace marrow
