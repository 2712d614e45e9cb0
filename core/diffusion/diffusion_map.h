// Eigen-pairs -> diffusion maps (Eq. 5) and distances (Eq. 6), and their means
// over a region (Eq. 12 to 15 of the paper).
#ifndef MARROW_CORE_DIFFUSION_DIFFUSION_MAP_H_
#define MARROW_CORE_DIFFUSION_DIFFUSION_MAP_H_

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// A row a vertex, a column an eigen-pair: e^(-lambda t) phi(x). The diffusion
// distance of two vertices is the squared distance of their rows.
using DiffusionMap =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Eq. 10: t of a region that has `area_share` of the mesh's area. `slowest` is
// the first eigenvalue besides that of the constant pair, or what
// core/diffusion/slowest_mode.h says.
double TimeScale(double slowest, double area_share);

// The number of pairs besides the constant one with e^(-lambda t) > delta, at
// least 1; a cluster of equal eigenvalues is taken whole. No value where the
// map may want pairs beyond those at hand.
std::optional<uint32_t> MapDimension(const EigenPairs& pairs, double t,
                                     double delta);

// The pairs besides the constant one, `most` of them, but for the last where
// they are equal and more follow that are, or may.
uint32_t NumPairsOfWholeClusters(
    const EigenPairs& pairs,
    uint32_t most = std::numeric_limits<uint32_t>::max());

// The maps of the given vertices of the mesh, in their order.
DiffusionMap BuildDiffusionMap(const EigenPairs& pairs,
                               std::span<const uint32_t> vertices, double t,
                               uint32_t dimension);

inline double DiffusionDistance(const DiffusionMap& Phi, uint32_t a,
                                uint32_t b) {
  return (Phi.row(a) - Phi.row(b)).squaredNorm();
}

// A set of faces with areas, whose corners are rows of a diffusion map. What
// the means below integrate over.
struct FaceSet {
  std::span<const Triangle> triangles;  // all faces of the region
  std::span<const double> areas;        // parallel to triangles
  std::span<const uint32_t> members;    // the faces of the set
};

// The average diffusion distance (ADD) from a point to the faces of a set.
class AverageDistance {
 public:
  // REQUIRES: the set has positive area.
  AverageDistance(const DiffusionMap& Phi, const FaceSet& set);

  // Eq. 12 for the vertex of row v.
  double At(uint32_t v) const;
  // Eq. 14.
  double Mean() const;

 private:
  const DiffusionMap& Phi_;
  Eigen::RowVectorXd mean_;  // of Phi over the set
  double Q_;                 // Eq. 13
};

// Eq. 15: the mean over the set of a function that is `distance` at the
// vertices (rows), the squared distance to a medial structure. May be negative.
double MeanDistance(const DiffusionMap& Phi, const FaceSet& set,
                    std::span<const double> distance);

}  // namespace marrow

#endif  // MARROW_CORE_DIFFUSION_DIFFUSION_MAP_H_
