#include "tests/testing/invariants.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/mesh/canonical_mesh.h"
#include "core/operators/bodies.h"
#include "gtest/gtest.h"

namespace marrow {
namespace {

bool StrictlyAscending(const std::vector<uint32_t>& values) {
  return std::adjacent_find(values.begin(), values.end(),
                            std::greater_equal<>()) == values.end();
}

void ExpectSoundNode(const TriangleMesh& mesh, const SegmentNode& node) {
  EXPECT_FALSE(node.faces.empty());
  EXPECT_FALSE(node.medial_structure.empty());
  EXPECT_TRUE(StrictlyAscending(node.faces));
  EXPECT_TRUE(StrictlyAscending(node.medial_structure));
  const std::vector<uint32_t> vertices = VerticesOf(mesh, node.faces);
  EXPECT_TRUE(std::includes(vertices.begin(), vertices.end(),
                            node.medial_structure.begin(),
                            node.medial_structure.end()));
  EXPECT_TRUE(node.centroid.allFinite());
  const Eigen::Vector3d low = mesh.positions.colwise().minCoeff();
  const Eigen::Vector3d high = mesh.positions.colwise().maxCoeff();
  const double slack = 1e-9 * (high - low).maxCoeff();
  EXPECT_TRUE((node.centroid.array() >= low.array() - slack).all());
  EXPECT_TRUE((node.centroid.array() <= high.array() + slack).all());
}

// The mesh as its bodies are computed on: with the patches of those that are
// sieves behind its faces, and what they had sewn as one. Itself where none is.
TriangleMesh WithPatches(const TriangleMesh& mesh) {
  CanonicalMesh canonical;
  canonical.mesh = mesh;
  canonical.report = ReportOn(mesh);
  TriangleMesh result = mesh;
  for (const Body& body : FindBodies(canonical, CancelToken()).bodies) {
    if (body.patched == nullptr) continue;
    std::map<uint32_t, uint32_t> sewn;
    for (const auto& [one, other] : body.seams) sewn[other] = one;
    for (Triangle& face : result.faces)
      for (uint32_t& v : face)
        if (const auto at = sewn.find(v); at != sewn.end()) v = at->second;
    const std::vector<Triangle>& faces = body.patched->mesh.faces;
    for (size_t f = body.faces.size(); f < faces.size(); ++f)
      result.faces.push_back({body.vertices[faces[f][0]],
                              body.vertices[faces[f][1]],
                              body.vertices[faces[f][2]]});
  }
  return result;
}

// `in_order`: siblings are ordered by all of their area, for nothing else is
// attached to them, nor patches gone.
void ExpectSoundFamily(const Adjacency& adjacency, const Adjacency& patched,
                       const SegmentTree& tree, const SegmentNode& node,
                       bool in_order) {
  std::vector<uint32_t> faces;
  double area = 0;
  const bool in_one = CountPieces(adjacency, node.faces) == 1;
  for (size_t i = 0; i < node.children.size(); ++i) {
    const SegmentNode& child = tree.nodes[node.children[i]];
    EXPECT_GT(child.id, node.id);
    EXPECT_EQ(child.parent, node.id);
    EXPECT_EQ(child.level, node.level + 1);
    faces.insert(faces.end(), child.faces.begin(), child.faces.end());
    area += child.area;
    if (in_one) {
      EXPECT_EQ(CountPieces(patched, child.faces, adjacency.NumFaces()), 1u)
          << "node " << child.id;
    }
    if (i == 0) continue;
    const SegmentNode& elder = tree.nodes[node.children[i - 1]];
    EXPECT_GT(child.id, elder.id);
    EXPECT_TRUE(!in_order || elder.area > child.area ||
                (elder.area == child.area &&
                 elder.faces.front() < child.faces.front()));
  }
  std::sort(faces.begin(), faces.end());
  EXPECT_EQ(faces, node.faces);
  EXPECT_NEAR(area, node.area, 1e-9 * node.area);
}

// Salience never grows down the tree, and an only child is there because a
// deeper cut splits it.
void ExpectSoundMerge(const SegmentTree& tree, const SegmentNode& node) {
  EXPECT_GE(node.salience, 0);
  EXPECT_LE(node.salience, 1);
  for (uint32_t child : node.children)
    EXPECT_LE(tree.nodes[child].salience, node.salience);
  if (node.children.size() == 1) {
    EXPECT_FALSE(tree.nodes[node.children[0]].children.empty());
  }
}

void ExpectPartition(const SegmentTree& tree, uint32_t level) {
  const std::vector<uint32_t> segments = tree.SegmentsAtLevel(level);
  EXPECT_TRUE(StrictlyAscending(segments));
  std::vector<uint32_t> owner(tree.nodes[0].faces.size(), kNoIndex);
  for (uint32_t id : segments)
    for (uint32_t f : tree.nodes[id].faces) {
      EXPECT_EQ(owner[f], kNoIndex) << "face " << f << " has two segments";
      owner[f] = id;
    }
  EXPECT_EQ(owner, tree.FaceSegments(level));
}

bool Touch(const TriangleMesh& mesh, const SegmentTree& tree, uint32_t a,
           uint32_t b) {
  const auto of_a = VerticesOf(mesh, tree.nodes[a].faces);
  const auto of_b = VerticesOf(mesh, tree.nodes[b].faces);
  std::vector<uint32_t> both;
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                        std::back_inserter(both));
  return both.size() >= 2;
}

}  // namespace

uint32_t CountPieces(const Adjacency& adjacency,
                     const std::vector<uint32_t>& faces, uint32_t first_patch) {
  std::vector<bool> left(adjacency.NumFaces(), false);
  for (uint32_t f = first_patch; f < adjacency.NumFaces(); ++f) left[f] = true;
  for (uint32_t f : faces) left[f] = true;
  uint32_t pieces = 0;
  std::vector<uint32_t> stack;
  const auto take = [&](uint32_t f) {
    if (left[f]) stack.push_back(f);
    left[f] = false;
  };
  for (uint32_t first : faces) {
    pieces += left[first];
    take(first);
    while (!stack.empty()) {
      const uint32_t f = stack.back();
      stack.pop_back();
      for (uint32_t e : adjacency.FaceEdges(f))
        for (uint32_t g : adjacency.EdgeFaces(e)) take(g);
    }
  }
  return pieces;
}

std::vector<uint32_t> VerticesOf(const TriangleMesh& mesh,
                                 const std::vector<uint32_t>& faces) {
  std::vector<uint32_t> vertices;
  for (uint32_t f : faces)
    vertices.insert(vertices.end(), mesh.faces[f].begin(), mesh.faces[f].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

void ExpectSoundTree(const TriangleMesh& mesh, const Adjacency& adjacency,
                     const SegmentTree& tree, double mesh_area, bool finished,
                     bool merged) {
  ASSERT_FALSE(tree.nodes.empty());
  EXPECT_EQ(tree.nodes[0].parent, kNoIndex);
  EXPECT_EQ(tree.nodes[0].level, 0u);
  EXPECT_EQ(tree.nodes[0].faces.size(), mesh.NumFaces());
  EXPECT_NEAR(tree.nodes[0].area, mesh_area, 1e-9 * mesh_area);
  const uint32_t pieces = CountPieces(adjacency, tree.nodes[0].faces);
  const Adjacency patched(WithPatches(mesh));
  uint32_t depth = 0;
  for (uint32_t id = 0; id < tree.nodes.size(); ++id) {
    SCOPED_TRACE(::testing::Message() << "node " << id);
    const SegmentNode& node = tree.nodes[id];
    ASSERT_EQ(node.id, id);
    // Breadth first: levels and parents never fall.
    EXPECT_GE(node.level, depth);
    depth = node.level;
    if (id > 1) {
      EXPECT_GE(node.parent, tree.nodes[id - 1].parent);
    }
    ExpectSoundNode(mesh, node);
    if (merged) {
      ExpectSoundMerge(tree, node);
    } else {
      EXPECT_NE(node.children.size(), 1u);
      EXPECT_EQ(node.salience, 0);
    }
    if (!node.children.empty()) {
      EXPECT_EQ(node.stop_reason, StopReason::kNone);
      // A root that is several bodies is not relaxed, nor are shells, which are
      // pieces by themselves.
      if (node.children.size() == 1) {
        EXPECT_EQ(node.iterations, 0u);
      } else if (pieces == 1 || (!merged && id > 0)) {
        EXPECT_GE(node.iterations, 1u);
      }
      ExpectSoundFamily(
          adjacency, patched, tree, node,
          pieces == 1 && patched.NumFaces() == adjacency.NumFaces());
    } else if (finished) {
      EXPECT_NE(node.stop_reason, StopReason::kNone);
    }
  }
  for (uint32_t level = 0; level <= depth + 1; ++level)
    ExpectPartition(tree, level);
}

void ExpectSoundSkeleton(const TriangleMesh& mesh, const Adjacency& adjacency,
                         const SegmentTree& tree, uint32_t level,
                         const Skeleton& skeleton) {
  std::map<uint32_t, uint32_t> centres;  // segment -> joint
  for (uint32_t j = 0; j < skeleton.joints.size(); ++j) {
    SCOPED_TRACE(::testing::Message() << "joint " << j);
    const Joint& joint = skeleton.joints[j];
    EXPECT_TRUE(joint.position.allFinite());
    if (j == 0) {
      EXPECT_EQ(joint.parent, kNoIndex);
    } else {
      ASSERT_LT(joint.parent, j);
    }
    if (joint.articulation) {
      ASSERT_EQ(joint.segments.size(), 2u);
      EXPECT_TRUE(Touch(mesh, tree, joint.segments[0], joint.segments[1]) ||
                  CountPieces(adjacency, tree.nodes[0].faces) > 1);
      // Its parent is the centre of the first segment.
      ASSERT_GT(j, 0u);
      EXPECT_EQ(centres.at(joint.segments[0]), joint.parent);
      continue;
    }
    ASSERT_EQ(joint.segments.size(), 1u);
    EXPECT_TRUE(centres.emplace(joint.segments[0], j).second);
    EXPECT_EQ(joint.position, tree.nodes[joint.segments[0]].centroid);
    if (j > 0 && skeleton.joints[joint.parent].articulation) {
      EXPECT_EQ(skeleton.joints[joint.parent].segments[1], joint.segments[0]);
    }
  }
  std::vector<uint32_t> segments;
  for (const auto& [segment, joint] : centres) segments.push_back(segment);
  EXPECT_EQ(segments, tree.SegmentsAtLevel(level));
  // In one piece, every segment but the root's hangs on an articulation.
  if (CountPieces(adjacency, tree.nodes[0].faces) == 1) {
    EXPECT_EQ(skeleton.joints.size(), 2 * segments.size() - 1);
  }
}

}  // namespace marrow
