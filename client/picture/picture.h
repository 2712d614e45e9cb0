// A picture of a segmented mesh, drawn in software.
#ifndef MARROW_CLIENT_PICTURE_PICTURE_H_
#define MARROW_CLIENT_PICTURE_PICTURE_H_

#include <cstdint>
#include <span>
#include <string>

#include "absl/status/statusor.h"
#include "client/polygon_mesh.h"
#include "client/segmentation.h"

namespace marrow {

struct PictureOptions {
  int width = 1600;   // pixels, 16 to 4096
  int height = 800;   // pixels, 16 to 4096
  int num_views = 2;  // 1 or 2: the second shows what the first hides
};

// A PNG (8-bit RGB) of the mesh in the colours of SegmentColor(), with dark
// lines between segments and the skeleton over it: bones as lines, centres of
// segments as blue discs, articulations as gray discs, a ring around the root.
//
// The views are chosen so that much of every segment is seen; surface.h and
// camera.h say how. Faces with a corner that is not finite, and joints whose
// position is not, are left out; a mesh without a face to draw gives an empty
// picture. The same input gives the same bytes. Thread-safe. Takes about 60
// bytes of memory a pixel and 100 a face.
//
// InvalidArgument unless there is one label a face and the options are in
// their ranges.
absl::StatusOr<std::string> DrawPng(const PolygonMesh& mesh,
                                    std::span<const uint32_t> face_labels,
                                    const client::Skeleton& skeleton,
                                    const PictureOptions& options = {});

}  // namespace marrow

#endif  // MARROW_CLIENT_PICTURE_PICTURE_H_
