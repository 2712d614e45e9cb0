// A diffusion map in few dimensions, so that most distances need not be
// measured in many.
#ifndef MARROW_CORE_PIECES_MAP_SKETCH_H_
#define MARROW_CORE_PIECES_MAP_SKETCH_H_

#include <Eigen/Core>
#include <cstdint>

#include "core/diffusion/diffusion_map.h"

namespace marrow {

// The rows of a diffusion map, projected orthogonally onto the directions in
// which they differ most: the distance of two sketches is at most that of the
// rows. Maps of no more dimensions are sketched by themselves, with zeros
// behind. Immutable, hence thread safe; Phi must outlive it.
class MapSketch {
 public:
  static constexpr int kDimensions = 16;

  explicit MapSketch(const DiffusionMap& Phi);

  const DiffusionMap& Phi() const { return *Phi_; }
  // kDimensions numbers.
  const double* Row(uint32_t v) const { return rows_.row(v).data(); }
  // The squared distance of two sketches may exceed that of the rows by this,
  // which is what rounding does.
  double slack() const { return slack_; }

 private:
  using Rows =
      Eigen::Matrix<double, Eigen::Dynamic, kDimensions, Eigen::RowMajor>;

  const DiffusionMap* Phi_;
  Rows rows_;
  double slack_;
};

}  // namespace marrow

#endif  // MARROW_CORE_PIECES_MAP_SKETCH_H_
