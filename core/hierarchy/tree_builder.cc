#include "core/hierarchy/tree_builder.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>
#include <utility>

#include "core/base/status_macros.h"
#include "core/hierarchy/segment_node.h"
#include "core/spectrum/team.h"

namespace marrow {
std::vector<uint32_t> SegmentTree::SegmentsAtLevel(uint32_t level) const {
  std::vector<uint32_t> segments;
  for (const SegmentNode& node : nodes)
    if (node.level == level || (node.level < level && node.children.empty()))
      segments.push_back(node.id);
  return segments;
}

std::vector<uint32_t> SegmentTree::FaceSegments(uint32_t level) const {
  std::vector<uint32_t> segment_of_face(nodes[0].faces.size(), 0);
  for (uint32_t id : SegmentsAtLevel(level))
    for (uint32_t f : nodes[id].faces) segment_of_face[f] = id;
  return segment_of_face;
}

TreeBuilder::TreeBuilder(const SplitContext& context,
                         const SplitOptions& options, double mesh_area)
    : context_(context), options_(options), mesh_area_(mesh_area) {
  Piece whole;
  whole.faces.resize(context.mesh.NumFaces());
  std::iota(whole.faces.begin(), whole.faces.end(), 0u);
  whole.medial_structure = MedialStructureOf(context, whole.faces, options);
  tree_.nodes.push_back(MakeNode(context_, mesh_area_, std::move(whole)));
}

double TreeBuilder::LeastShare(double least) const {
  double share = 1;
  for (uint32_t id : DeepestOf(least))
    if (tree_.nodes[id].area > 0 &&
        tree_.nodes[id].faces.size() >= kMinRegionFaces)
      share = std::min(share, tree_.nodes[id].area / mesh_area_);
  return share;
}

std::vector<uint32_t> TreeBuilder::DeepestOf(double least) const {
  std::vector<uint32_t> nodes;
  for (const SegmentNode& node : tree_.nodes)
    if (node.level == depth_ && node.area >= least * mesh_area_)
      nodes.push_back(node.id);
  return nodes;
}

absl::StatusOr<bool> TreeBuilder::Deepen(
    const CancelToken& cancel, const std::function<void(double)>& progress,
    double least, size_t fewest) {
  const std::vector<uint32_t> leaves = DeepestOf(least);
  if (leaves.empty()) return false;
  std::vector<absl::StatusOr<RegionSplit>> splits =
      SplitAll(leaves, cancel, progress);
  bool any = false;
  for (size_t i = 0; i < leaves.size(); ++i) {
    MARROW_RETURN_IF_ERROR(splits[i].status());
    if (splits[i]->pieces.size() < fewest) splits[i]->pieces.clear();
    any |= !splits[i]->pieces.empty();
    AddChildren(leaves[i], *std::move(splits[i]));
  }
  if (any) ++depth_;
  return any;
}

std::vector<absl::StatusOr<RegionSplit>> TreeBuilder::SplitAll(
    const std::vector<uint32_t>& leaves, const CancelToken& cancel,
    const std::function<void(double)>& progress) const {
  std::vector<absl::StatusOr<RegionSplit>> splits(leaves.size());
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<double> tried = 0;
  const auto report = [&] {
    if (progress) progress(std::min(1.0, tried.load()));
  };
  Team team(std::min(UsualThreads(), static_cast<int>(leaves.size())));
  const int threads_each = UsualThreads() / team.threads();
  team.For(static_cast<int>(leaves.size()), [&](int i) {
    const SegmentNode& leaf = tree_.nodes[leaves[i]];
    splits[i] =
        SplitRegion(context_, leaf.faces, options_, cancel, threads_each);
    tried += leaf.area / mesh_area_;
    if (std::this_thread::get_id() == caller) report();
  });
  report();
  return splits;
}

void TreeBuilder::StopAtDepth() {
  for (SegmentNode& node : tree_.nodes)
    if (node.level == depth_ && node.stop_reason == StopReason::kNone)
      node.stop_reason = StopReason::kDepth;
}

void TreeBuilder::AddChildren(uint32_t parent, RegionSplit split) {
  tree_.nodes[parent].iterations = split.iterations;
  tree_.nodes[parent].stop_reason = split.stop_reason;
  std::vector<SegmentNode> children;
  for (Piece& piece : split.pieces)
    children.push_back(MakeNode(context_, mesh_area_, std::move(piece)));
  AppendChildren(parent, std::move(children), tree_);
}

}  // namespace marrow
