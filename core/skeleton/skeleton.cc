#include "core/skeleton/skeleton.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "core/base/disjoint_sets.h"
#include "core/pieces/face_links.h"

namespace marrow {
namespace {

// Where two segments meet: the shared edges of their longest common opening.
struct Boundary {
  uint32_t a, b;  // places in the level's list of segments, a < b
  double length = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  bool bridged = false;  // between shells, without a shared edge
};

using EdgeList = std::vector<uint32_t>;
using SharedEdgesMap = std::map<std::pair<uint32_t, uint32_t>, EdgeList>;

// Edges between each pair of segments, by places.
SharedEdgesMap SharedEdges(const Adjacency& adjacency,
                           const std::vector<uint32_t>& place_of_face) {
  SharedEdgesMap shared;
  std::vector<uint32_t> around;
  for (uint32_t e = 0; e < adjacency.NumEdges(); ++e) {
    around.clear();
    for (uint32_t f : adjacency.EdgeFaces(e))
      around.push_back(place_of_face[f]);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    for (size_t i = 1; i < around.size(); ++i)
      shared[{around[i - 1], around[i]}].push_back(e);
  }
  return shared;
}

// The openings of segments: what edges between a segment and any others
// connect. Where a third segment comes between, two runs of a boundary are of
// the same openings, and one joint.
class Openings {
 public:
  Openings(const Adjacency& adjacency, const SharedEdgesMap& shared) {
    for (const auto& [places, edges] : shared)
      for (uint32_t e : edges)
        for (uint32_t v : adjacency.EdgeVertices(e))
          for (uint32_t place : {places.first, places.second})
            numbers_.try_emplace({place, v}, numbers_.size());
    sets_.emplace(static_cast<uint32_t>(numbers_.size()));
    for (const auto& [places, edges] : shared)
      for (uint32_t e : edges) {
        const auto [u, v] = adjacency.EdgeVertices(e);
        for (uint32_t place : {places.first, places.second})
          sets_->Union(numbers_.at({place, u}), numbers_.at({place, v}));
      }
  }

  uint32_t Of(uint32_t place, uint32_t v) {
    return sets_->Find(numbers_.at({place, v}));
  }

 private:
  absl::flat_hash_map<std::pair<uint32_t, uint32_t>, uint32_t> numbers_;
  std::optional<DisjointSets> sets_;
};

// Of the runs that are of the same openings of both segments, the longest.
Boundary LongestRun(const TriangleMesh& mesh, const Adjacency& adjacency,
                    std::pair<uint32_t, uint32_t> places, const EdgeList& edges,
                    Openings& openings) {
  std::map<std::pair<uint32_t, uint32_t>, Boundary> candidates;
  for (uint32_t e : edges) {
    const auto [u, v] = adjacency.EdgeVertices(e);
    Boundary& run = candidates
                        .try_emplace({openings.Of(places.first, u),
                                      openings.Of(places.second, u)},
                                     Boundary{places.first, places.second})
                        .first->second;
    const double length = (mesh.Position(u) - mesh.Position(v)).norm();
    run.length += length;
    run.centre += 0.5 * length * (mesh.Position(u) + mesh.Position(v));
  }
  Boundary longest =
      std::max_element(candidates.begin(), candidates.end(),
                       [](const auto& x, const auto& y) {
                         return x.second.length < y.second.length;
                       })
          ->second;
  longest.centre /= longest.length;
  return longest;
}

using Bridges = std::span<const std::array<uint32_t, 2>>;
using BoundaryMap = std::map<std::pair<uint32_t, uint32_t>, Boundary>;

uint32_t SharedVertex(const Triangle& a, const Triangle& b) {
  return *std::find_first_of(a.begin(), a.end(), b.begin(), b.end());
}

// Where segments of different shells are near: in the middle of the bridges,
// and about as long as the rim on which those stand, whose every vertex has
// one. Where shells touch in a vertex, at that.
BoundaryMap BridgedBoundaries(const TriangleMesh& mesh,
                              const Adjacency& adjacency,
                              const std::vector<uint32_t>& place,
                              Bridges bridges) {
  BoundaryMap found;
  const auto add = [&](uint32_t f, uint32_t g, const Eigen::Vector3d& middle) {
    const auto [a, b] = std::minmax(place[f], place[g]);
    const auto [p, q] = adjacency.EdgeVertices(adjacency.FaceEdges(f)[0]);
    const double rim = 0.5 * (mesh.Position(p) - mesh.Position(q)).norm();
    if (a == b || rim == 0) return;
    Boundary& boundary = found[{a, b}];
    boundary.a = a;
    boundary.b = b;
    boundary.bridged = true;
    boundary.length += rim;
    boundary.centre += rim * middle;
  };
  for (const auto& [u, v] : bridges)
    add(adjacency.VertexFaces(u).front(), adjacency.VertexFaces(v).front(),
        0.5 * (mesh.Position(u) + mesh.Position(v)));
  for (const auto& [f, g] : TouchingFaces(adjacency))
    add(f, g, mesh.Position(SharedVertex(mesh.faces[f], mesh.faces[g])));
  for (auto& [places, boundary] : found) boundary.centre /= boundary.length;
  return found;
}

std::vector<Boundary> FindBoundaries(const TriangleMesh& mesh,
                                     const Adjacency& adjacency,
                                     const std::vector<uint32_t>& place,
                                     Bridges bridges) {
  std::vector<Boundary> boundaries;
  BoundaryMap bridged = BridgedBoundaries(mesh, adjacency, place, bridges);
  const SharedEdgesMap shared = SharedEdges(adjacency, place);
  Openings openings(adjacency, shared);
  for (const auto& [places, edges] : shared) {
    Boundary run = LongestRun(mesh, adjacency, places, edges, openings);
    if (run.length > 0) {
      bridged.erase(places);
      boundaries.push_back(run);
    }
  }
  for (const auto& [places, boundary] : bridged) boundaries.push_back(boundary);
  std::sort(boundaries.begin(), boundaries.end(),
            [](const Boundary& x, const Boundary& y) {
              return std::tie(y.length, x.a, x.b) <
                     std::tie(x.length, y.a, y.b);
            });
  return boundaries;
}

// A way from one segment to another; without a boundary it bridges bodies.
struct Link {
  uint32_t a, b;
  const Boundary* boundary;
};

// Boundaries that may carry a bone: those of at least a quarter of the longest
// of either segment, so that a bone does not run through a mere contact, and
// those that connect what would else fall apart. Between shells only the
// latter: a leg hangs on the hip, not on the cloth around both.
std::vector<Link> StrongLinks(const std::vector<Boundary>& boundaries,
                              DisjointSets& joined) {
  constexpr double kStrong = 0.25;
  std::map<uint32_t, double> longest;
  for (const Boundary& boundary : boundaries)  // longest first
    for (uint32_t s : {boundary.a, boundary.b})
      longest.emplace(s, boundary.length);
  std::vector<Link> links;
  for (const Boundary& boundary : boundaries) {
    if (boundary.bridged) continue;
    const bool connects = joined.Union(boundary.a, boundary.b);
    if (connects || boundary.length >= kStrong * longest[boundary.a] ||
        boundary.length >= kStrong * longest[boundary.b])
      links.push_back({boundary.a, boundary.b, &boundary});
  }
  for (const Boundary& boundary : boundaries)
    if (boundary.bridged && joined.Union(boundary.a, boundary.b))
      links.push_back({boundary.a, boundary.b, &boundary});
  return links;
}

// Joins every body that is not yet joined to the root's by its centre nearest
// to one that is (Prim's algorithm over segments).
void JoinBodies(const std::vector<Eigen::Vector3d>& centres, uint32_t root,
                DisjointSets& joined, std::vector<Link>& links) {
  const uint32_t n = static_cast<uint32_t>(centres.size());
  std::vector<double> distance(n, std::numeric_limits<double>::infinity());
  std::vector<uint32_t> nearest(n, root);
  std::vector<bool> reached(n, false);
  std::vector<uint32_t> fresh;
  auto reach_body_of = [&](uint32_t s) {
    for (uint32_t other = 0; other < n; ++other)
      if (!reached[other] && joined.Find(other) == joined.Find(s)) {
        reached[other] = true;
        fresh.push_back(other);
      }
  };
  reach_body_of(root);
  while (true) {
    for (uint32_t from : fresh)
      for (uint32_t to = 0; to < n; ++to)
        if (!reached[to] &&
            (centres[to] - centres[from]).norm() < distance[to]) {
          distance[to] = (centres[to] - centres[from]).norm();
          nearest[to] = from;
        }
    fresh.clear();
    uint32_t best = kNoIndex;
    for (uint32_t s = 0; s < n; ++s)
      if (!reached[s] && (best == kNoIndex || distance[s] < distance[best]))
        best = s;
    if (best == kNoIndex) return;
    links.push_back({nearest[best], best, nullptr});
    reach_body_of(best);
  }
}

// The place of the segment that has most of the faces around the vertices.
uint32_t RootPlace(const Adjacency& adjacency, const SegmentCover& cover,
                   const std::vector<uint32_t>& vertices) {
  std::vector<uint32_t> votes(cover.ids.size(), 0);
  for (uint32_t v : vertices)
    for (uint32_t f : adjacency.VertexFaces(v)) ++votes[cover.place_of_face[f]];
  return static_cast<uint32_t>(std::max_element(votes.begin(), votes.end()) -
                               votes.begin());
}

double LengthOf(const Link& link, const std::vector<Eigen::Vector3d>& centres) {
  if (link.boundary == nullptr)
    return (centres[link.a] - centres[link.b]).norm();
  return (centres[link.a] - link.boundary->centre).norm() +
         (centres[link.b] - link.boundary->centre).norm();
}

// A segment reached from the root: the link it was reached by, if any.
struct Reached {
  uint32_t place;
  uint32_t from;
  const Boundary* boundary;
};

// Dijkstra from the root: every segment hangs on its shortest way to it. Ties
// go to the lesser place.
std::vector<Reached> ShortestWays(const std::vector<Link>& links,
                                  const std::vector<Eigen::Vector3d>& centres,
                                  uint32_t root) {
  std::vector<std::vector<const Link*>> around(centres.size());
  for (const Link& link : links) {
    around[link.a].push_back(&link);
    around[link.b].push_back(&link);
  }
  using Entry = std::tuple<double, uint32_t, uint32_t, const Boundary*>;
  auto later = [](const Entry& x, const Entry& y) {
    return std::tie(std::get<0>(x), std::get<1>(x), std::get<2>(x)) >
           std::tie(std::get<0>(y), std::get<1>(y), std::get<2>(y));
  };
  std::priority_queue<Entry, std::vector<Entry>, decltype(later)> queue(later);
  std::vector<bool> done(centres.size(), false);
  std::vector<Reached> order;
  queue.push({0.0, root, kNoIndex, nullptr});
  while (!queue.empty()) {
    const auto [distance, place, from, boundary] = queue.top();
    queue.pop();
    if (done[place]) continue;
    done[place] = true;
    order.push_back({place, from, boundary});
    for (const Link* link : around[place])
      queue.push({distance + LengthOf(*link, centres),
                  link->a == place ? link->b : link->a, place, link->boundary});
  }
  return order;
}

Skeleton LayOut(const std::vector<Reached>& order,
                const std::vector<uint32_t>& segments,
                const std::vector<Eigen::Vector3d>& centres) {
  Skeleton skeleton;
  std::vector<uint32_t> joint_of(segments.size(), kNoIndex);
  auto add = [&](Joint joint) {
    skeleton.joints.push_back(std::move(joint));
    return static_cast<uint32_t>(skeleton.joints.size() - 1);
  };
  for (const auto& [place, from, boundary] : order) {
    uint32_t parent = from == kNoIndex ? kNoIndex : joint_of[from];
    if (boundary != nullptr)
      parent = add(
          {parent, true, boundary->centre, {segments[from], segments[place]}});
    joint_of[place] = add({parent, false, centres[place], {segments[place]}});
  }
  return skeleton;
}

}  // namespace

Skeleton BuildSkeleton(const TriangleMesh& mesh, const Adjacency& adjacency,
                       const SegmentTree& tree, uint32_t level,
                       Bridges bridges) {
  SegmentCover cover;
  cover.ids = tree.SegmentsAtLevel(level);
  cover.place_of_face.resize(mesh.NumFaces());
  for (uint32_t s = 0; s < cover.ids.size(); ++s) {
    const SegmentNode& node = tree.nodes[cover.ids[s]];
    for (uint32_t f : node.faces) cover.place_of_face[f] = s;
    cover.centres.push_back(node.centroid);
  }
  return BuildSkeleton(mesh, adjacency, cover, tree.nodes[0].medial_structure,
                       bridges);
}

Skeleton BuildSkeleton(const TriangleMesh& mesh, const Adjacency& adjacency,
                       const SegmentCover& cover,
                       const std::vector<uint32_t>& centre_of_mesh,
                       Bridges bridges) {
  const uint32_t root = RootPlace(adjacency, cover, centre_of_mesh);
  const std::vector<Boundary> boundaries =
      FindBoundaries(mesh, adjacency, cover.place_of_face, bridges);
  DisjointSets joined(static_cast<uint32_t>(cover.ids.size()));
  std::vector<Link> links = StrongLinks(boundaries, joined);
  JoinBodies(cover.centres, root, joined, links);
  return LayOut(ShortestWays(links, cover.centres, root), cover.ids,
                cover.centres);
}

}  // namespace marrow
