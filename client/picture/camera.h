// Where to look from.
#ifndef MARROW_CLIENT_PICTURE_CAMERA_H_
#define MARROW_CLIENT_PICTURE_CAMERA_H_

#include <Eigen/Core>
#include <vector>

#include "client/picture/surface.h"

namespace marrow {

// Rows: to the right, upwards, towards the viewer. A rotation.
using View = Eigen::Matrix3f;

// `count` views of a surface of any orientation. The second view is the one
// that adds most to what the first shows.
std::vector<View> ChooseViews(const Surface& surface, int count);

}  // namespace marrow

#endif  // MARROW_CLIENT_PICTURE_CAMERA_H_
