#include "core/operators/scenery.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/mesh/unit_box.h"

namespace marrow {
namespace {

// Of the radius: so thin a component is flat.
constexpr double kFlatness = 1e-3;
// There is a ground and a sky or two; a crowd is not looked through.
constexpr size_t kMostLookedAt = 8;

// Vertices, each once, seen from their mean.
class Extent {
 public:
  Extent(const Positions& unit, std::vector<uint32_t> vertices)
      : unit_(unit), vertices_(std::move(vertices)) {
    for (uint32_t v : vertices_) middle_ += unit_.row(v);
    middle_ /= std::max<size_t>(1, vertices_.size());
    for (uint32_t v : vertices_) radius_ = std::max(radius_, DistanceTo(v));
  }

  double radius() const { return radius_; }
  const Eigen::RowVector3d& middle() const { return middle_; }

  bool IsFlat() const {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (uint32_t v : vertices_) {
      const Eigen::RowVector3d from = unit_.row(v) - middle_;
      spread += from.transpose() * from;
    }
    const Eigen::Vector3d across =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread)
            .eigenvectors()
            .col(0);
    return std::all_of(vertices_.begin(), vertices_.end(), [&](uint32_t v) {
      return std::abs((unit_.row(v) - middle_).dot(across)) <=
             kFlatness * radius_;
    });
  }

  // Whether all the others are nearer to the middle than any of these.
  bool IsAround(const Extent& others) const {
    double nearest = radius_;
    for (uint32_t v : vertices_) nearest = std::min(nearest, DistanceTo(v));
    return (others.middle_ - middle_).norm() + others.radius_ < nearest;
  }

 private:
  double DistanceTo(uint32_t v) const {
    return (unit_.row(v) - middle_).norm();
  }

  const Positions& unit_;
  const std::vector<uint32_t> vertices_;
  Eigen::RowVector3d middle_ = Eigen::RowVector3d::Zero();
  double radius_ = 0;
};

class SceneryFinder {
 public:
  SceneryFinder(const TriangleMesh& mesh,
                const std::vector<std::vector<uint32_t>>& components)
      : mesh_(mesh),
        components_(components),
        unit_(ToUnitBox(mesh).points),
        taken_(mesh.NumVertices(), 0),
        is_scenery_(components.size(), false) {}

  std::vector<bool> Find(const CancelToken& cancel) {
    for (uint32_t c : Widest(cancel)) {
      if (cancel.IsCancelled()) break;
      if (!IsScenery(c)) break;
      is_scenery_[c] = true;
    }
    return is_scenery_;
  }

 private:
  Extent ExtentOf(const std::vector<uint32_t>& faces) {
    ++asked_;
    std::vector<uint32_t> vertices;
    for (uint32_t f : faces)
      for (uint32_t v : mesh_.faces[f])
        if (std::exchange(taken_[v], asked_) != asked_) vertices.push_back(v);
    return Extent(unit_, std::move(vertices));
  }

  // Some components, by falling radius.
  std::vector<uint32_t> Widest(const CancelToken& cancel) {
    std::vector<double> radius(components_.size(), 0);
    for (size_t c = 0; c < components_.size() && !cancel.IsCancelled(); ++c)
      radius[c] = ExtentOf(components_[c]).radius();
    std::vector<uint32_t> order(components_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      return radius[a] > radius[b];
    });
    order.resize(std::min(order.size(), kMostLookedAt));
    return order;
  }

  bool IsScenery(uint32_t c) {
    size_t count = 0;
    for (uint32_t i = 0; i < components_.size(); ++i)
      if (i != c && !is_scenery_[i]) count += components_[i].size();
    const double faces = static_cast<double>(components_[c].size());
    if (faces > kFlatShare * count) return false;
    std::vector<uint32_t> others;
    others.reserve(count);
    for (uint32_t i = 0; i < components_.size(); ++i)
      if (i != c && !is_scenery_[i])
        others.insert(others.end(), components_[i].begin(),
                      components_[i].end());
    const Extent own = ExtentOf(components_[c]), rest = ExtentOf(others);
    if (own.radius() < kScenerySize * rest.radius()) return false;
    return (faces <= kPlainFaces && faces <= kPlainShare * count) ||
           own.IsFlat() ||
           (faces <= kEnclosingShare * count && own.IsAround(rest));
  }

  const TriangleMesh& mesh_;
  const std::vector<std::vector<uint32_t>>& components_;
  const Positions unit_;
  std::vector<uint32_t> taken_;  // vertex -> when it was asked for last
  uint32_t asked_ = 0;
  std::vector<bool> is_scenery_;
};

}  // namespace

std::vector<bool> FindScenery(
    const TriangleMesh& mesh,
    const std::vector<std::vector<uint32_t>>& components,
    const CancelToken& cancel) {
  if (components.size() < 2) return std::vector<bool>(components.size(), false);
  return SceneryFinder(mesh, components).Find(cancel);
}

}  // namespace marrow
