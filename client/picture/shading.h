// Light on a surface that has been rasterised.
#ifndef MARROW_CLIENT_PICTURE_SHADING_H_
#define MARROW_CLIENT_PICTURE_SHADING_H_

#include <Eigen/Core>
#include <vector>

#include "client/picture/camera.h"
#include "client/picture/image.h"
#include "client/picture/raster.h"
#include "client/picture/surface.h"

namespace marrow {

// Samples a pixel, along each side.
inline constexpr int kSupersampling = 2;

// Draws what `buffer` sees into the columns of `image` from `left` on, over
// what is there. `points` are those of the surface in samples, as given to
// Rasterize(); `view` turned them.
//
// REQUIRES: the buffer's size is a multiple of kSupersampling, and fits.
void Shade(const Surface& surface, const View& view,
           const std::vector<Eigen::Vector3f>& points,
           const DepthBuffer& buffer, int left, Image& image);

}  // namespace marrow

#endif  // MARROW_CLIENT_PICTURE_SHADING_H_
