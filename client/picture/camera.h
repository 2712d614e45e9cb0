// Where to look from.
#ifndef MARROW_CLIENT_PICTURE_CAMERA_H_
#define MARROW_CLIENT_PICTURE_CAMERA_H_

#include <Eigen/Core>
#include <vector>

#include "client/picture/surface.h"

namespace marrow {

// Rows: to the right, upwards, towards the viewer. A rotation.
using View = Eigen::Matrix3f;

// `count` views of a surface of unknown orientation, by these rules:
//
// 1. Up is the file's y or z: the one on which the creature would stand,
//    with its centre of mass above what touches the floor. Where it would on
//    both, the one along which it is longer; y where nothing tells.
// 2. Of views from all around, at three heights, the first is the one that
//    shows most of the segments, small ones counted for more than their area,
//    views square to the broad side for a little less.
// 3. The next view is the one that adds most to what those before it show.
std::vector<View> ChooseViews(const Surface& surface, int count);

}  // namespace marrow

#endif  // MARROW_CLIENT_PICTURE_CAMERA_H_
