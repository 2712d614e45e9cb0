#include "core/hierarchy/cut.h"

#include <algorithm>
#include <queue>
#include <tuple>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/boundaries/calibration.h"

namespace marrow {
namespace {

constexpr uint32_t kAutomaticPaperLevel = 2;
constexpr uint32_t kDeepest = 0xFFFFFFFFu;

std::string FieldAt(const char* list, size_t i) {
  return absl::StrCat("cut.", list, "[", i, "]");
}

absl::Status CheckIds(const char* list, const std::vector<uint32_t>& ids,
                      const SegmentTree& tree) {
  for (size_t i = 0; i < ids.size(); ++i)
    if (ids[i] >= tree.nodes.size())
      return InvalidField(
          FieldAt(list, i),
          absl::StrCat("is ", ids[i], "; the tree has the nodes 0 to ",
                       tree.nodes.size() - 1));
  return absl::OkStatus();
}

// The leaves of the paper's tree, numbered from 0.
std::vector<uint32_t> LeafOfFace(const SegmentTree& tree) {
  const std::vector<uint32_t> leaves = tree.SegmentsAtLevel(kDeepest);
  std::vector<uint32_t> place(tree.nodes.size(), 0);
  for (uint32_t i = 0; i < leaves.size(); ++i) place[leaves[i]] = i;
  std::vector<uint32_t> leaf_of_face = tree.FaceSegments(kDeepest);
  for (uint32_t& leaf : leaf_of_face) leaf = place[leaf];
  return leaf_of_face;
}

// Least members of the sets in which `key` is equal.
template <typename Key>
std::vector<uint32_t> LeastOfEqual(const std::vector<Key>& key) {
  std::map<Key, uint32_t> first;
  std::vector<uint32_t> least(key.size());
  for (uint32_t i = 0; i < key.size(); ++i)
    least[i] = first.emplace(key[i], i).first->second;
  return least;
}

}  // namespace

CutSpec CutSpec::AtLevel(uint32_t level) {
  CutSpec spec;
  spec.by = By::kLevel;
  spec.level = level;
  return spec;
}

CutSpec CutSpec::Into(uint32_t segments) {
  CutSpec spec;
  spec.by = By::kSegments;
  spec.segments = segments;
  return spec;
}

CutSpec CutSpec::AtSalience(double salience) {
  CutSpec spec;
  spec.by = By::kSalience;
  spec.salience = salience;
  return spec;
}

TreeCutter::TreeCutter(const SegmentTree& tree,
                       std::vector<uint32_t> piece_of_face, MergeOrder order,
                       std::vector<double> thresholds)
    : tree_(tree),
      piece_of_face_(std::move(piece_of_face)),
      order_(std::move(order)),
      thresholds_(std::move(thresholds)),
      coarsest_level_(0) {
  FindPiecesOfNodes();
}

TreeCutter::TreeCutter(const SegmentTree& tree, bool several_bodies)
    : tree_(tree),
      piece_of_face_(LeafOfFace(tree)),
      coarsest_level_(several_bodies ? 1 : 0) {
  FindPiecesOfNodes();
}

void TreeCutter::FindPiecesOfNodes() {
  num_pieces_ =
      1 + *std::max_element(piece_of_face_.begin(), piece_of_face_.end());
  // One face stands for each piece.
  std::vector<uint32_t> first_face(num_pieces_, kNoIndex);
  for (uint32_t f = 0; f < piece_of_face_.size(); ++f)
    if (first_face[piece_of_face_[f]] == kNoIndex)
      first_face[piece_of_face_[f]] = f;
  pieces_of_node_.resize(tree_.nodes.size());
  for (const SegmentNode& node : tree_.nodes) {
    std::vector<uint32_t>& pieces = pieces_of_node_[node.id];
    for (uint32_t f : node.faces)
      if (first_face[piece_of_face_[f]] == f)
        pieces.push_back(piece_of_face_[f]);
    std::sort(pieces.begin(), pieces.end());
    nodes_[{pieces.front(), static_cast<uint32_t>(pieces.size())}].push_back(
        node.id);
  }
}

absl::StatusOr<TreeCut> TreeCutter::Apply(const CutSpec& spec) const {
  MARROW_RETURN_IF_ERROR(CheckNodes(spec));
  Base base = MakeBase(spec);
  Open(spec.open, base.groups);
  Close(spec.closed, base.groups);
  return Name(base);
}

absl::Status TreeCutter::CheckNodes(const CutSpec& spec) const {
  MARROW_RETURN_IF_ERROR(CheckIds("closed", spec.closed, tree_));
  MARROW_RETURN_IF_ERROR(CheckIds("open", spec.open, tree_));
  std::vector<bool> closed(tree_.nodes.size(), false);
  for (uint32_t id : spec.closed) closed[id] = true;
  for (size_t i = 0; i < spec.open.size(); ++i) {
    if (tree_.nodes[spec.open[i]].children.empty())
      return InvalidField(
          FieldAt("open", i),
          absl::StrCat("is ", spec.open[i],
                       ", a segment without children; only one that has "
                       "some can be held open"));
    for (uint32_t id = spec.open[i]; id != kNoIndex;
         id = tree_.nodes[id].parent)
      if (closed[id])
        return InvalidField(
            FieldAt("open", i),
            absl::StrCat("is ", spec.open[i],
                         id == spec.open[i] ? ", which" : ", inside of which ",
                         id == spec.open[i] ? "" : absl::StrCat(id),
                         " is to be held closed; open it or close it"));
  }
  return absl::OkStatus();
}

TreeCutter::Base TreeCutter::MakeBase(const CutSpec& spec) const {
  const bool automatic = spec.by == CutSpec::By::kAutomatic;
  if (spec.by == CutSpec::By::kLevel || (automatic && !order_)) {
    const uint32_t level = automatic ? kAutomaticPaperLevel : spec.level;
    double salience = 0;
    if (!thresholds_.empty())
      salience = thresholds_[std::min<size_t>(level, thresholds_.size()) - 1];
    return {GroupsOf(tree_.SegmentsAtLevel(level)), salience, level};
  }
  if (!order_) return {GroupsOf(LargestSplitInto(spec.segments)), 0, 0};
  // The labels of the automatic cut are nodes of the tree, however few levels
  // of it were asked for.
  if (automatic)
    return AtSalience(thresholds_.empty()
                          ? kAutomaticSalience
                          : std::max(kAutomaticSalience, thresholds_.back()));
  if (spec.by == CutSpec::By::kSalience) return AtSalience(spec.salience);
  return AtSalience(order_->ThresholdInto(spec.segments));
}

TreeCutter::Base TreeCutter::AtSalience(double threshold) const {
  const auto level = std::partition_point(
      thresholds_.begin(), thresholds_.end(),
      [&](double coarser) { return coarser >= threshold; });
  return {order_->CutAt(threshold), std::min(threshold, 1.0),
          static_cast<uint32_t>(level - thresholds_.begin())};
}

TreeCutter::Partition TreeCutter::GroupsOf(
    const std::vector<uint32_t>& nodes) const {
  Partition groups(num_pieces_);
  for (uint32_t id : nodes)
    for (uint32_t p : pieces_of_node_[id])
      groups[p] = pieces_of_node_[id].front();
  return groups;
}

// The order of the splits is the same for every count, so that cuts into more
// refine those into fewer.
std::vector<uint32_t> TreeCutter::LargestSplitInto(uint32_t count) const {
  using Entry = std::tuple<double, uint32_t>;  // area, id falling
  std::priority_queue<Entry> queue;
  const auto push = [&](uint32_t id) {
    queue.push({tree_.nodes[id].area, kDeepest - id});
  };
  for (uint32_t id : tree_.SegmentsAtLevel(coarsest_level_)) push(id);
  std::vector<uint32_t> leaves;
  while (!queue.empty()) {
    const SegmentNode& node =
        tree_.nodes[kDeepest - std::get<uint32_t>(queue.top())];
    if (node.children.empty()) {
      leaves.push_back(node.id);
    } else if (leaves.size() + queue.size() - 1 + node.children.size() >
               count) {
      break;
    }
    queue.pop();
    for (uint32_t child : node.children) push(child);
  }
  for (; !queue.empty(); queue.pop())
    leaves.push_back(kDeepest - std::get<uint32_t>(queue.top()));
  return leaves;
}

void TreeCutter::Open(const std::vector<uint32_t>& nodes,
                      Partition& groups) const {
  if (nodes.empty()) return;
  std::vector<bool> split(tree_.nodes.size(), false);
  for (uint32_t id : nodes) {
    // An only child is the same segment again.
    while (tree_.nodes[id].children.size() == 1)
      id = tree_.nodes[id].children[0];
    for (; id != kNoIndex; id = tree_.nodes[id].parent) split[id] = true;
  }
  // Pieces stay together that the cut and all splits leave together.
  std::vector<std::pair<uint32_t, uint32_t>> key(num_pieces_);
  for (uint32_t p = 0; p < num_pieces_; ++p) key[p] = {groups[p], 0};
  for (const SegmentNode& node : tree_.nodes)
    if (split[node.id])
      for (uint32_t child : node.children)
        for (uint32_t p : pieces_of_node_[child]) key[p].second = child;
  groups = LeastOfEqual(key);
}

void TreeCutter::Close(const std::vector<uint32_t>& nodes,
                       Partition& groups) const {
  for (uint32_t id : nodes) {
    const std::vector<uint32_t>& pieces = pieces_of_node_[id];
    const bool whole = std::all_of(
        pieces.begin(), pieces.end(),
        [&](uint32_t p) { return groups[p] == groups[pieces.front()]; });
    if (whole) continue;
    for (uint32_t p : pieces) groups[p] = pieces.front();
  }
}

TreeCut TreeCutter::Name(const Base& base) const {
  std::map<uint32_t, uint32_t> sizes;
  for (uint32_t group : base.groups) ++sizes[group];
  std::vector<double> inner;
  if (order_) inner = order_->InnerSalience(base.groups);
  uint32_t next_id = static_cast<uint32_t>(tree_.nodes.size());
  std::vector<std::pair<TreeCut::Segment, uint32_t>> named;
  for (const auto& [least, size] : sizes) {
    TreeCut::Segment segment;
    segment.id = NodeOf(least, size, base.level);
    if (segment.id != kNoIndex) {
      const SegmentNode& node = tree_.nodes[segment.id];
      segment.parent = node.parent;
      segment.level = node.level;
      segment.salience = node.salience;
    } else {
      segment.id = next_id++;
      segment.parent = NodeAbove(least, size);
      segment.level = tree_.nodes[segment.parent].level + 1;
      segment.salience = inner.empty() ? 0 : inner[least];
    }
    named.push_back({segment, least});
  }
  std::sort(named.begin(), named.end(), [](const auto& a, const auto& b) {
    return a.first.id < b.first.id;
  });
  TreeCut cut;
  cut.salience = base.salience;
  std::vector<uint32_t> place(num_pieces_);
  for (const auto& [segment, least] : named) {
    place[least] = static_cast<uint32_t>(cut.segments.size());
    cut.segments.push_back(segment);
  }
  for (uint32_t group : base.groups)
    cut.segment_of_piece.push_back(place[group]);
  return cut;
}

uint32_t TreeCutter::NodeOf(uint32_t least_piece, uint32_t num_pieces,
                            uint32_t level) const {
  const auto it = nodes_.find({least_piece, num_pieces});
  if (it == nodes_.end()) return kNoIndex;
  uint32_t found = it->second.front();
  for (uint32_t id : it->second)
    if (tree_.nodes[id].level <= level) found = id;
  return found;
}

uint32_t TreeCutter::NodeAbove(uint32_t piece, uint32_t num_pieces) const {
  uint32_t above = 0;
  while (true) {
    const std::vector<uint32_t>& children = tree_.nodes[above].children;
    const auto child =
        std::find_if(children.begin(), children.end(), [&](uint32_t id) {
          const std::vector<uint32_t>& pieces = pieces_of_node_[id];
          return pieces.size() > num_pieces &&
                 std::binary_search(pieces.begin(), pieces.end(), piece);
        });
    if (child == children.end()) return above;
    above = *child;
  }
}

}  // namespace marrow
