#include "core/pieces/medial_structure.h"

#include <algorithm>
#include <nanoflann.hpp>

#include "core/pieces/ranked_set.h"

namespace marrow {
namespace {

// Below this many points, or above this many dimensions, looking at every point
// beats walking a tree.
constexpr Eigen::Index kTreePoints = 48;
constexpr Eigen::Index kTreeDimensions = 24;

}  // namespace

std::vector<uint32_t> ComputeMedialStructure(const Region& region,
                                             const DiffusionMap& Phi,
                                             std::span<const uint32_t> members,
                                             double epsilon) {
  std::vector<uint32_t> vertices =
      RankedSet(region.triangles(), members).Members();
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
  using Metric = nanoflann::L2_Simple_Adaptor<double, Cloud>;

  // Begins with a point that is known, unlike nanoflann's own results.
  struct Nearest {
    double distance;
    uint32_t point;

    bool addPoint(double other_distance, uint32_t other) {
      if (other_distance < distance) *this = {other_distance, other};
      return true;
    }
    double worstDist() const { return distance; }
    bool full() const { return true; }
  };

  explicit Index(const DiffusionMap& points)
      : cloud{points}, tree(static_cast<int>(points.cols()), cloud) {}

  Cloud cloud;
  nanoflann::KDTreeSingleIndexAdaptor<Metric, Cloud, -1> tree;
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

double StructureDistance::From(uint32_t& point, uint32_t vertex) const {
  if (!index_)
    return (points_.rowwise() - Phi_->row(vertex))
        .rowwise()
        .squaredNorm()
        .minCoeff();
  const double* query = Phi_->row(vertex).data();
  Index::Nearest nearest{
      Index::Metric(index_->cloud).evalMetric(query, point, points_.cols()),
      point};
  index_->tree.findNeighbors(nearest, query, nanoflann::SearchParams());
  point = nearest.point;
  return nearest.distance;
}

}  // namespace marrow
