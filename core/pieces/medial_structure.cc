#include "core/pieces/medial_structure.h"

#include <algorithm>
#include <nanoflann.hpp>
#include <utility>

#include "core/pieces/ranked_set.h"

namespace marrow {
namespace {

constexpr int kDimensions = MapSketch::kDimensions;

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

// The nearest point so far, as nanoflann's searches ask for it: they offer
// every point whose sketch is nearer than worstDist().
struct StructureDistance::Nearest {
  const StructureDistance& structure;
  uint32_t vertex;
  double distance;
  uint32_t point = 0;

  bool addPoint(double, uint32_t other) {
    const auto difference =
        structure.points_.row(other) - structure.sketch_->Phi().row(vertex);
    const double measured = difference.squaredNorm();
    if (measured < distance) {
      distance = measured;
      point = other;
    }
    return true;
  }
  double worstDist() const {
    return distance > 0 ? distance + structure.sketch_->slack() : 0;
  }
  bool full() const { return true; }
};

struct StructureDistance::Index {
  // nanoflann's view of the sketches.
  struct Cloud {
    std::vector<double> rows;

    size_t kdtree_get_point_count() const { return rows.size() / kDimensions; }
    double kdtree_get_pt(size_t i, size_t d) const {
      return rows[i * kDimensions + d];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };

  // nanoflann's own adds up one number after the other.
  struct Metric {
    using ElementType = double;
    using DistanceType = double;
    using Row = Eigen::Map<const Eigen::Matrix<double, kDimensions, 1>>;

    explicit Metric(const Cloud& of) : cloud(of) {}
    double evalMetric(const double* query, size_t i, size_t) const {
      return (Row(query) - Row(&cloud.rows[i * kDimensions])).squaredNorm();
    }
    double accum_dist(double a, double b, size_t) const {
      return (a - b) * (a - b);
    }

    const Cloud& cloud;
  };

  explicit Index(std::vector<double> rows)
      : cloud{std::move(rows)}, tree(kDimensions, cloud) {}

  Cloud cloud;
  nanoflann::KDTreeSingleIndexAdaptor<Metric, Cloud, kDimensions> tree;
};

StructureDistance::StructureDistance(const MapSketch& sketch,
                                     const std::vector<uint32_t>& structure)
    : sketch_(&sketch), points_(structure.size(), sketch.Phi().cols()) {
  std::vector<double> rows;
  rows.reserve(structure.size() * kDimensions);
  for (size_t i = 0; i < structure.size(); ++i) {
    points_.row(i) = sketch.Phi().row(structure[i]);
    const double* row = sketch.Row(structure[i]);
    rows.insert(rows.end(), row, row + kDimensions);
  }
  index_ = std::make_unique<Index>(std::move(rows));
}

StructureDistance::~StructureDistance() = default;
StructureDistance::StructureDistance(StructureDistance&&) noexcept = default;

double StructureDistance::From(uint32_t& point, uint32_t vertex,
                               double bound) const {
  const double* query = sketch_->Row(vertex);
  Nearest nearest{*this, vertex, bound};
  const double first =
      index_->tree.distance.evalMetric(query, point, kDimensions);
  if (first < nearest.worstDist()) nearest.addPoint(first, point);
  if (points_.rows() > 1)
    index_->tree.findNeighbors(nearest, query, nanoflann::SearchParams());
  point = nearest.point;
  return nearest.distance;
}

}  // namespace marrow
