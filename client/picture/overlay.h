// A skeleton drawn over an image.
#ifndef MARROW_CLIENT_PICTURE_OVERLAY_H_
#define MARROW_CLIENT_PICTURE_OVERLAY_H_

#include <Eigen/Core>
#include <vector>

#include "client/picture/image.h"
#include "client/segmentation.h"

namespace marrow {

// Bones as lines with a light outline, centres of segments as blue discs,
// articulations as smaller gray ones, a ring around the root. `positions` are
// the joints' in pixels, one a joint; joints that are not finite or more than a
// million pixels away are left out, and their bones too. `unit` is the width of
// a bone in pixels.
void DrawSkeleton(const client::Skeleton& skeleton,
                  const std::vector<Eigen::Vector2f>& positions, float unit,
                  Image& image);

}  // namespace marrow

#endif  // MARROW_CLIENT_PICTURE_OVERLAY_H_
