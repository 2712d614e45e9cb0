#include "core/mesh/t_junctions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "core/base/cancellable.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/rims.h"
#include "core/mesh/unit_box.h"
#include "core/mesh/vertex_cloud.h"

namespace marrow {
namespace {

constexpr double kMostBreadth = 1e-3;
constexpr double kMostOfHeight = 0.1;
constexpr double kLeastFromEnd = 0.02;
constexpr size_t kMostNearest = 64;

// Finds what lies inside one edge after another.
class InsideEdges {
 public:
  InsideEdges(const Positions& points, const std::vector<uint32_t>& rim)
      : points_(points), rim_(rim), cloud_{points, rim}, tree_(3, cloud_) {}

  // The vertices inside the edge from a to b, but none of `face`.
  std::vector<uint32_t> Of(uint32_t a, uint32_t b, const Triangle& face) {
    const Eigen::Vector3d from = points_.row(a).transpose();
    const Eigen::Vector3d along = points_.row(b).transpose() - from;
    const Eigen::Vector3d middle = from + along / 2;
    const double square = along.squaredNorm();
    const double breadth = SquaredBreadth(from, along, face);
    const size_t found = FindNearest(middle, square / 4);
    inside_.clear();
    for (size_t i = 0; i < found && squares_[i] < square / 4; ++i) {
      const uint32_t v = rim_[nearest_[i]];
      if (std::ranges::count(face, v) > 0) continue;
      const Eigen::Vector3d to = points_.row(v).transpose() - from;
      const double t = to.dot(along) / square;
      if (t < kLeastFromEnd || t > 1 - kLeastFromEnd) continue;
      if ((to - t * along).squaredNorm() <= breadth) inside_.push_back({t, v});
    }
    return InOrder();
  }

 private:
  // How many are nearer than the square root of `most_square`; of those the
  // nearest. The bound stands where the farthest will, so no more is searched
  // than that takes.
  size_t FindNearest(const Eigen::Vector3d& middle, double most_square) {
    nanoflann::KNNResultSet<double, uint32_t> near(kMostNearest);
    near.init(nearest_, squares_);
    squares_[kMostNearest - 1] = most_square;
    tree_.findNeighbors(near, middle.data(), nanoflann::SearchParams());
    return near.size();
  }

  // How far from the edge what is inside it may be.
  double SquaredBreadth(const Eigen::Vector3d& from,
                        const Eigen::Vector3d& along,
                        const Triangle& face) const {
    const double square = along.squaredNorm();
    double height = 0;  // times the edge, squared
    for (uint32_t v : face) {
      const Eigen::Vector3d to = points_.row(v).transpose() - from;
      height = std::max(height, to.cross(along).squaredNorm());
    }
    return std::min(kMostBreadth * kMostBreadth * square,
                    kMostOfHeight * kMostOfHeight * height / square);
  }

  // Of two at one place along the edge the greater is left out: faces between
  // them would have no breadth.
  std::vector<uint32_t> InOrder() {
    std::sort(inside_.begin(), inside_.end());
    std::vector<uint32_t> vertices;
    double last = 0;
    for (const auto& [t, v] : inside_) {
      if (t == last) continue;
      vertices.push_back(v);
      last = t;
    }
    return vertices;
  }

  const Positions& points_;
  const std::vector<uint32_t>& rim_;
  const VertexCloud cloud_;
  const VertexTree tree_;
  uint32_t nearest_[kMostNearest];
  double squares_[kMostNearest];
  std::vector<std::pair<double, uint32_t>> inside_;
};

// A part of a face, and which of its edges, counted from the corner that they
// leave, are still to be split.
struct Part {
  Triangle corners;
  std::array<bool, 3> whole;
};

void Split(const TJunctions& junctions, const Part& part,
           std::vector<Triangle>& leaves) {
  for (int i = 0; i < 3; ++i) {
    if (!part.whole[i]) continue;
    const int next = (i + 1) % 3, last = (i + 2) % 3;
    const uint32_t a = part.corners[i], b = part.corners[next],
                   c = part.corners[last];
    const auto inside = junctions.find({std::min(a, b), std::max(a, b)});
    if (inside == junctions.end()) continue;
    std::vector<uint32_t> stops = inside->second;
    if (std::ranges::count(stops, c) > 0) continue;
    if (b < a) std::reverse(stops.begin(), stops.end());
    stops.push_back(b);
    uint32_t from = a;
    for (uint32_t to : stops) {
      Split(
          junctions,
          {{from, to, c},
           {false, part.whole[next] && to == b, part.whole[last] && from == a}},
          leaves);
      from = to;
    }
    return;
  }
  leaves.push_back(part.corners);
}

}  // namespace

absl::StatusOr<TJunctions> FindTJunctions(const TriangleMesh& mesh,
                                          const CancelToken& cancel) {
  const Adjacency adjacency(mesh, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  TJunctions junctions;
  const std::vector<uint32_t> rim = RimVertices(adjacency);
  if (rim.size() <= 3) return junctions;
  const Positions points = ToUnitBox(mesh).points;
  InsideEdges inside(points, rim);
  size_t left = mesh.faces.size();
  const auto look = [&](uint32_t e) {
    if (!adjacency.IsBoundaryEdge(e)) return;
    const auto [a, b] = adjacency.EdgeVertices(e);
    std::vector<uint32_t> found =
        inside.Of(a, b, mesh.faces[adjacency.EdgeFaces(e)[0]]);
    if (found.empty() || found.size() > left) return;
    left -= found.size();
    junctions[{a, b}] = std::move(found);
  };
  MARROW_RETURN_IF_ERROR(ForEachIndex(adjacency.NumEdges(), cancel, look));
  return junctions;
}

std::vector<Triangle> SplitAt(const TJunctions& junctions,
                              const Triangle& face) {
  std::vector<Triangle> leaves;
  Split(junctions, {face, {true, true, true}}, leaves);
  return leaves;
}

}  // namespace marrow
