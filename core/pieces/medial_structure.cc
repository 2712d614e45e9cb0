#include "core/pieces/medial_structure.h"

#include <algorithm>
#include <limits>
#include <nanoflann.hpp>

namespace marrow {
namespace {

// Below this many points, or above this many dimensions, looking at every point
// beats walking a tree.
constexpr Eigen::Index kTreePoints = 48;
constexpr Eigen::Index kTreeDimensions = 24;

std::vector<uint32_t> CornersOf(const Region& region,
                                std::span<const uint32_t> members) {
  std::vector<uint32_t> vertices;
  vertices.reserve(3 * members.size());
  for (uint32_t f : members)
    vertices.insert(vertices.end(), region.triangles()[f].begin(),
                    region.triangles()[f].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace

std::vector<uint32_t> ComputeMedialStructure(const Region& region,
                                             const DiffusionMap& Phi,
                                             std::span<const uint32_t> members,
                                             double epsilon) {
  std::vector<uint32_t> vertices = CornersOf(region, members);
  double area = 0;
  for (uint32_t f : members) area += region.areas()[f];
  if (area <= 0) return vertices;

  const AverageDistance add(Phi, {region.triangles(), region.areas(), members});
  std::vector<double> values;
  values.reserve(vertices.size());
  for (uint32_t v : vertices) values.push_back(add.At(v));
  const double bound = *std::min_element(values.begin(), values.end()) +
                       epsilon * std::max(0.0, add.Mean());
  size_t kept = 0;
  for (size_t i = 0; i < vertices.size(); ++i)
    if (values[i] <= bound) vertices[kept++] = vertices[i];
  vertices.resize(kept);
  return vertices;
}

struct StructureDistance::Index {
  // nanoflann's view of the structure's points.
  struct Cloud {
    const DiffusionMap& points;

    size_t kdtree_get_point_count() const { return points.rows(); }
    double kdtree_get_pt(size_t i, size_t d) const { return points(i, d); }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };

  explicit Index(const DiffusionMap& points)
      : cloud{points}, tree(static_cast<int>(points.cols()), cloud) {}

  Cloud cloud;
  nanoflann::KDTreeSingleIndexAdaptor<
      nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, -1>
      tree;
};

StructureDistance::StructureDistance(const DiffusionMap& Phi,
                                     const std::vector<uint32_t>& structure)
    : Phi_(&Phi), points_(structure.size(), Phi.cols()) {
  for (size_t i = 0; i < structure.size(); ++i)
    points_.row(i) = Phi.row(structure[i]);
  if (points_.rows() >= kTreePoints && points_.cols() <= kTreeDimensions)
    index_ = std::make_unique<Index>(points_);
}

StructureDistance::~StructureDistance() = default;

// The tree refers to points_, so it is built again over the moved ones.
StructureDistance::StructureDistance(StructureDistance&& other) noexcept
    : Phi_(other.Phi_), points_(std::move(other.points_)) {
  if (other.index_) index_ = std::make_unique<Index>(points_);
}

double StructureDistance::operator()(uint32_t vertex) const {
  if (!index_)
    return (points_.rowwise() - Phi_->row(vertex))
        .rowwise()
        .squaredNorm()
        .minCoeff();
  uint32_t nearest = 0;
  double distance = std::numeric_limits<double>::infinity();
  index_->tree.knnSearch(Phi_->row(vertex).data(), 1, &nearest, &distance);
  return distance;
}

}  // namespace marrow
