#include "core/operators/bridges.h"

#include <algorithm>
#include <limits>
#include <nanoflann.hpp>
#include <utility>

#include "core/base/disjoint_sets.h"

namespace marrow {
namespace {

// Positions scaled to the unit box: squared distances of large coordinates
// would overflow.
struct UnitCloud {
  Positions points;

  explicit UnitCloud(const TriangleMesh& mesh) : points(mesh.positions) {
    const Eigen::RowVector3d low = points.colwise().minCoeff();
    points.rowwise() -= low;
    points /= points.maxCoeff();
  }
  size_t kdtree_get_point_count() const { return points.rows(); }
  double kdtree_get_pt(size_t i, size_t d) const { return points(i, d); }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using KdTree = nanoflann::KDTreeSingleIndexAdaptor<
    nanoflann::L2_Simple_Adaptor<double, UnitCloud>, UnitCloud, 3>;

struct Bridge {
  double distance = std::numeric_limits<double>::infinity();
  std::array<uint32_t, 2> ends{};

  friend bool operator<(const Bridge& a, const Bridge& b) {
    return std::tie(a.distance, a.ends) < std::tie(b.distance, b.ends);
  }
};

// A result set for nanoflann: the nearest point of another body, given the best
// that the own body has found so far.
class NearestElsewhere {
 public:
  NearestElsewhere(uint32_t from, const std::vector<uint32_t>& body,
                   Bridge& best)
      : from_(from), body_(body), best_(best) {}

  bool full() const { return true; }
  size_t size() const { return 1; }
  double worstDist() const {
    // Equal distances are looked at too: the least pair of vertices wins.
    return std::nextafter(best_.distance,
                          std::numeric_limits<double>::infinity());
  }
  bool addPoint(double distance, uint32_t index) {
    if (body_[index] == body_[from_]) return true;
    Bridge bridge{distance, {from_, index}};
    if (bridge.ends[0] > bridge.ends[1])
      std::swap(bridge.ends[0], bridge.ends[1]);
    best_ = std::min(best_, bridge);
    return true;
  }

 private:
  uint32_t from_;
  const std::vector<uint32_t>& body_;
  Bridge& best_;
};

// Every body but the largest looks for its nearest neighbour: the largest is
// found by others, and its many vertices need not search.
std::vector<Bridge> NearestBodies(const KdTree& tree, const UnitCloud& cloud,
                                  const std::vector<uint32_t>& body) {
  const uint32_t n = static_cast<uint32_t>(body.size());
  std::vector<uint32_t> size(n, 0);
  for (uint32_t b : body) ++size[b];
  const uint32_t largest = static_cast<uint32_t>(
      std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<Bridge> best(n);
  for (uint32_t v = 0; v < n; ++v) {
    if (body[v] == largest) continue;
    NearestElsewhere result(v, body, best[body[v]]);
    tree.findNeighbors(result, cloud.points.row(v).data(),
                       nanoflann::SearchParams());
  }
  return best;
}

}  // namespace

std::vector<std::array<uint32_t, 2>> FindBridges(const TriangleMesh& mesh) {
  const uint32_t n = mesh.NumVertices();
  DisjointSets sets(n);
  uint32_t bodies = n;
  for (const Triangle& face : mesh.faces)
    bodies -= sets.Union(face[0], face[1]) + sets.Union(face[0], face[2]);
  std::vector<std::array<uint32_t, 2>> bridges;
  if (bodies == 1) return bridges;

  const UnitCloud cloud(mesh);
  const KdTree tree(3, cloud);
  std::vector<uint32_t> body(n);
  while (bodies > 1) {
    for (uint32_t v = 0; v < n; ++v) body[v] = sets.Find(v);
    std::vector<Bridge> best = NearestBodies(tree, cloud, body);
    std::sort(best.begin(), best.end());
    for (const Bridge& bridge : best) {
      if (bridge.ends[0] == bridge.ends[1]) break;  // nothing was found
      if (!sets.Union(bridge.ends[0], bridge.ends[1])) continue;
      bridges.push_back(bridge.ends);
      --bodies;
    }
  }
  std::sort(bridges.begin(), bridges.end());
  return bridges;
}

}  // namespace marrow
